// compare_with_photographs SCENE VIEWS MESH [PICTURE.png]: how much a mesh's own colours, on its
// texture (.glb) or at its vertices (.ply), look like photographs, best such as it was not made
// from (docs/guide/textures.md). Views are indices with commas between them. The picture has the
// photographs on the left and the mesh on the right.
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "io/mesh/read_mesh.h"
#include "io/mesh/split_mesh.h"
#include "pipeline/texture_stage.h"
#include "raycast/ray_scene.h"
#include "scenes.h"
#include "support/scratch_folder.h"

namespace photohull::texture {
namespace {

constexpr int kReach = 3;                // of windows of 7 x 7 pixels
constexpr double kLeastVariance = 4e-4;  // of roots of linear light: what is plainer is not judged

TexturePage page_of(const aiScene& scene, const aiMesh& mesh) {
  aiString name;
  scene.mMaterials[mesh.mMaterialIndex]->GetTexture(aiTextureType_DIFFUSE, 0, &name);
  const aiTexture* embedded = scene.GetEmbeddedTexture(name.C_Str());
  if (!embedded) throw Error("the mesh has no texture");
  const ScratchFolder folder;
  std::ofstream(folder / "page.png", std::ios::binary)
      .write(reinterpret_cast<const char*>(embedded->pcData), embedded->mWidth);
  const ColourImage image = io::read_image(folder / "page.png");
  TexturePage page{image.width, image.height, {}};
  for (std::size_t i = 0; i < image.bytes.size(); i += 4)
    page.rgb.insert(page.rgb.end(), &image.bytes[i], &image.bytes[i] + 3);
  return page;
}

/// In the world in which `up` is upward.
TexturedMesh read_glb(const std::string& path, const glm::dvec3& up) {
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

struct Sums {
  double squared = 0, score = 0;
  std::int64_t values = 0, windows = 0;

  void print(const std::string& name) const {
    std::printf("%-8s PSNR %.2f dB, ZNCC %.4f\n", name.c_str(),
                -10 * std::log10(squared / double(values)), score / double(windows));
  }
};

/// Two pictures in sRGB, one after another in `rgb`; where the second shows nothing, `shown` is 0.
struct Pair {
  int width = 0, height = 0;
  std::vector<std::uint8_t> photograph, mesh, shown;

  double root(const std::vector<std::uint8_t>& rgb, int x, int y) const {
    const std::uint8_t* p = &rgb[3 * (std::size_t(y) * width + x)];
    return std::sqrt(0.2126 * linear_from_srgb(p[0] / 255.0) +
                     0.7152 * linear_from_srgb(p[1] / 255.0) +
                     0.0722 * linear_from_srgb(p[2] / 255.0));
  }
};

/// Normalised cross-correlation around a pixel; nothing where the photograph is plain, or the mesh
/// not all around.
std::optional<double> zncc(const Pair& pair, int x, int y) {
  double a = 0, b = 0, aa = 0, bb = 0, ab = 0, n = 0;
  for (int j = y - kReach; j <= y + kReach; ++j)
    for (int i = x - kReach; i <= x + kReach; ++i, ++n) {
      if (!pair.shown[std::size_t(j) * pair.width + i]) return std::nullopt;
      const double p = pair.root(pair.photograph, i, j), q = pair.root(pair.mesh, i, j);
      a += p;
      b += q;
      aa += p * p;
      bb += q * q;
      ab += p * q;
    }
  const double va = aa - a * a / n, vb = bb - b * b / n;
  if (va < n * kLeastVariance) return std::nullopt;
  return (ab - a * b / n) / std::sqrt(va * std::max(vb, 1e-6 * n));
}

Pair draw(const TexturedMesh& mesh, const RayScene& rays, const SourceView& view) {
  const ColourImage image = io::read_image(view.image);
  Pair out{image.width, image.height, {}, {}, {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const std::uint8_t* p = &image.bytes[4 * (std::size_t(y) * image.width + x)];
      out.photograph.insert(out.photograph.end(), p, p + 3);
      const auto hit = rays.closest(view.camera.center(), view.camera.ray({double(x), double(y)}));
      out.shown.push_back(hit.has_value());
      glm::vec3 colour(0);
      if (hit) {
        const glm::dvec3 weights(1 - hit->u - hit->v, hit->u, hit->v);
        if (!mesh.texture.pages.empty())
          colour = colour_at(mesh.texture, hit->triangle, weights);
        else
          for (int i = 0; i < 3; ++i)
            colour += float(weights[i]) * mesh.mesh.colours[mesh.mesh.triangles[hit->triangle][i]];
      }
      for (int c = 0; c < 3; ++c)
        out.mesh.push_back(std::uint8_t(
            std::lround(255 * srgb_from_linear(std::clamp(double(colour[c]), 0.0, 1.0)))));
    }
  return out;
}

Sums compare(const Pair& pair) {
  Sums sums;
  for (int y = kReach; y < pair.height - kReach; ++y)
    for (int x = kReach; x < pair.width - kReach; ++x) {
      const std::size_t i = std::size_t(y) * pair.width + x;
      if (!pair.shown[i]) continue;
      for (std::size_t c = 3 * i; c < 3 * i + 3; ++c)
        sums.squared += std::pow((pair.photograph[c] - pair.mesh[c]) / 255.0, 2);
      sums.values += 3;
      if (const auto score = zncc(pair, x, y)) {
        sums.score += *score;
        ++sums.windows;
      }
    }
  return sums;
}

void add_picture(const Pair& pair, int width, std::vector<std::uint8_t>& rgb) {
  if (2 * pair.width != width) return;
  for (int y = 0; y < pair.height; ++y)
    for (const auto* side : {&pair.photograph, &pair.mesh}) {
      const auto row = side->begin() + std::ptrdiff_t(3) * y * pair.width;
      rgb.insert(rgb.end(), row, row + std::ptrdiff_t(3) * pair.width);
    }
}

int run(const std::vector<std::string>& arguments) {
  if (arguments.size() < 3) throw UsageError("usage: SCENE VIEWS MESH [PICTURE.png]");
  const Scene scene = io::load_scene(arguments[0], {});
  std::vector<PreparedView> cameras;
  for (const SourceView& view : scene.views) cameras.push_back({view.name, view.camera, {}, {}});
  const bool textured = arguments[2].ends_with(".glb");
  TexturedMesh mesh;
  if (textured)
    mesh = read_glb(arguments[2], pipeline::upward_axis(cameras));
  else
    mesh.mesh = read_mesh(arguments[2]);
  const RayScene rays(mesh.mesh);
  Sums all;
  std::vector<std::uint8_t> picture;
  int width = 0;
  std::stringstream views(arguments[1]);
  for (std::string index; std::getline(views, index, ',');) {
    const Pair pair = draw(mesh, rays, scene.views.at(std::size_t(std::stoi(index))));
    const Sums sums = compare(pair);
    sums.print(index);
    all.squared += sums.squared;
    all.values += sums.values;
    all.score += sums.score;
    all.windows += sums.windows;
    if (width == 0) width = 2 * pair.width;
    add_picture(pair, width, picture);
  }
  all.print("all");
  if (arguments.size() > 3)
    io::write_png(arguments[3], width, int(picture.size() / 3 / std::size_t(width)), 3, picture);
  return 0;
}

}  // namespace
}  // namespace photohull::texture

int main(int count, char** values) {
  try {
    return photohull::texture::run({values + 1, values + count});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
