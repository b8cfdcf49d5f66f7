#include "read_textured.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <filesystem>
#include <fstream>

#include "core/error.h"
#include "io/image_file.h"
#include "io/mesh/split_mesh.h"
#include "support/scratch_folder.h"

namespace photohull::texture {
namespace {

RgbImage page_of(const aiScene& scene, const aiMesh& mesh) {
  aiString name;
  scene.mMaterials[mesh.mMaterialIndex]->GetTexture(aiTextureType_DIFFUSE, 0, &name);
  const aiTexture* embedded = scene.GetEmbeddedTexture(name.C_Str());
  if (!embedded) throw Error("the mesh has no texture");
  const ScratchFolder folder;
  std::ofstream(folder / "page.png", std::ios::binary)
      .write(reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth);
  const ColourImage image = io::read_image(folder / "page.png");
  RgbImage page{image.width, image.height, {}};
  for (std::size_t i = 0; i < image.bytes.size(); i += 4)
    page.rgb.insert(page.rgb.end(), &image.bytes[i], &image.bytes[i] + 3);
  return page;
}

}  // namespace

TexturedMesh read_textured(const std::string& path, const glm::dvec3& up) {
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_PreTransformVertices);
  if (!scene) throw Error(importer.GetErrorString());
  const glm::dmat3 back = glm::transpose(y_up_from_world(up));
  TexturedMesh out;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    const auto first = std::uint32_t(out.mesh.positions.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const aiVector3D& p = part.mVertices[v];
      out.mesh.positions.emplace_back(back * glm::dvec3(p.x, p.y, p.z));
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const unsigned* corners = part.mFaces[f].mIndices;
      out.mesh.triangles.push_back({first + corners[0], first + corners[1], first + corners[2]});
      out.texture.page.push_back(m);
      std::array<glm::vec2, 3> places;
      for (std::size_t i = 0; i < 3; ++i) {
        const aiVector3D& at = part.mTextureCoords[0][corners[i]];  // from below
        places[i] = {at.x, 1 - at.y};
      }
      out.texture.corners.push_back(places);
    }
    out.texture.pages.push_back(page_of(*scene, part));
  }
  return out;
}

}  // namespace photohull::texture
