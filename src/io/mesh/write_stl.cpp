// Binary STL, by assimp.
#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <assimp/Exporter.hpp>
#include <memory>

#include "core/error.h"
#include "io/mesh/mesh_writers.h"

namespace photohull {
namespace {

/// Its destructor frees what it points to.
std::unique_ptr<aiMesh> to_assimp(const TriMesh& mesh, double scale) {
  auto out = std::make_unique<aiMesh>();
  out->mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
  out->mNumVertices = unsigned(mesh.positions.size());
  out->mVertices = new aiVector3D[mesh.positions.size()];
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3 p(scale * mesh.world(i));
    out->mVertices[i] = aiVector3D(p.x, p.y, p.z);
  }
  out->mNumFaces = unsigned(mesh.triangles.size());
  out->mFaces = new aiFace[mesh.triangles.size()];
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    out->mFaces[i].mNumIndices = 3;
    out->mFaces[i].mIndices =
        new unsigned[3]{mesh.triangles[i][0], mesh.triangles[i][1], mesh.triangles[i][2]};
  }
  return out;
}

}  // namespace

void write_stl(AtomicFile& file, const MeshContents& contents, const OpenBeside&) {
  const double millimetres = contents.options.unit ? 1000 * contents.options.metres() : 1;
  aiScene scene;
  scene.mNumMaterials = 1;
  scene.mMaterials = new aiMaterial* [1] { new aiMaterial };
  scene.mNumMeshes = 1;
  scene.mMeshes = new aiMesh* [1] { to_assimp(contents.mesh, millimetres).release() };
  scene.mRootNode = new aiNode;
  scene.mRootNode->mNumMeshes = 1;
  scene.mRootNode->mMeshes = new unsigned[1]{0};
  Assimp::Exporter exporter;
  const aiExportDataBlob* bytes = exporter.ExportToBlob(&scene, "stlb");
  if (!bytes) throw Error(concat(file.target().string(), ": ", exporter.GetErrorString()));
  file.write(bytes->data, bytes->size);
}

}  // namespace photohull
