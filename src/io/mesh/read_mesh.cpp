#include "io/mesh/read_mesh.h"

#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <fstream>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/error.h"
#include "io/mesh/mesh_soup.h"
#include "io/mesh/write_mesh.h"

namespace photohull {
namespace {

constexpr double kFarthest = 1e30;               // fits a float
constexpr std::size_t kMostVertices = 1u << 28;  // also what instances of meshes add up to

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

/// Keeps what assimp complains of but repairs by guessing.
class RangeComplaints : public Assimp::LogStream {
 public:
  void write(const char* message) override {
    for (const char* phrase : {"out of range", "out-of-range"})
      found = found || std::strstr(message, phrase) != nullptr;
  }
  bool found = false;
};

glm::dmat4 matrix(const aiMatrix4x4& m) {
  return glm::transpose(glm::dmat4(m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3,
                                   m.c4, m.d1, m.d2, m.d3, m.d4));
}

void add_mesh(const std::filesystem::path& path, const aiMesh& mesh, const glm::dmat4& world,
              Soup& soup) {
  const std::size_t first = soup.positions.size();
  if (first + mesh.mNumVertices > kMostVertices)
    fail_to_read(path, "it has more than 268 million vertices", "give a smaller mesh");
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    const aiVector3D& p = mesh.mVertices[v];
    soup.positions.emplace_back(world * glm::dvec4(p.x, p.y, p.z, 1));
  }
  const bool mirrored = glm::determinant(glm::dmat3(world)) < 0;
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    for (unsigned i = 0; i < face.mNumIndices; ++i)
      if (face.mIndices[i] >= mesh.mNumVertices)
        fail_to_read(path, concat("face ", f, " has a vertex index out of range"),
                     "repair the file");
    for (unsigned i = 2; i < face.mNumIndices; ++i) {  // none for points and lines
      const auto corner = [&](unsigned k) { return std::uint32_t(first + face.mIndices[k]); };
      const std::uint32_t second = corner(mirrored ? i : i - 1),
                          third = corner(mirrored ? i - 1 : i);
      soup.triangles.push_back({corner(0), second, third});
    }
  }
}

Soup flatten(const std::filesystem::path& path, const aiScene& scene) {
  Soup soup;
  std::vector<std::pair<const aiNode*, glm::dmat4>> open;
  if (scene.mRootNode) open.emplace_back(scene.mRootNode, glm::dmat4(1));
  while (!open.empty()) {
    const auto [node, parent] = open.back();
    open.pop_back();
    const glm::dmat4 world = parent * matrix(node->mTransformation);
    for (unsigned i = 0; i < node->mNumMeshes; ++i)
      add_mesh(path, *scene.mMeshes[node->mMeshes[i]], world, soup);
    for (unsigned i = node->mNumChildren; i-- > 0;) open.emplace_back(node->mChildren[i], world);
  }
  return soup;
}

Soup read_with_assimp(const std::filesystem::path& path) {
  static std::mutex logger;  // assimp's is global
  const std::scoped_lock lock(logger);
  RangeComplaints complaints;
  constexpr unsigned kSeverities = Assimp::Logger::Err | Assimp::Logger::Warn;
  Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
  Assimp::DefaultLogger::get()->attachStream(&complaints, kSeverities);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path.string(), 0);
  Assimp::DefaultLogger::get()->detachStream(&complaints, kSeverities);
  Assimp::DefaultLogger::kill();
  if (complaints.found)
    fail_to_read(path, "a face has a vertex index out of range", "repair or export the mesh again");
  if (!scene) {
    std::string reason = importer.GetErrorString();
    std::replace(reason.begin(), reason.end(), '\n', ' ');
    fail_to_read(path, reason.empty() ? "it is damaged" : reason, "give a complete file");
  }
  return flatten(path, *scene);
}

void check_positions(const std::filesystem::path& path, const std::vector<glm::dvec3>& positions) {
  for (std::size_t v = 0; v < positions.size(); ++v)
    if (!glm::all(glm::lessThan(glm::abs(positions[v]), glm::dvec3(kFarthest))))
      fail_to_read(path, concat("the position of vertex ", v, " is no usable number"),
                   "repair the mesh");
}

struct PositionHash {
  std::size_t operator()(const glm::vec3& p) const {
    std::uint64_t h = 0;
    for (int i = 0; i < 3; ++i) h = (h ^ std::bit_cast<std::uint32_t>(p[i])) * 0x9e3779b97f4a7c15u;
    return std::size_t(h ^ (h >> 32));
  }
};

/// One vertex a position; + 0.0 makes the two zeros one.
TriMesh join(const Soup& soup) {
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (const glm::dvec3& p : soup.positions) {
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  TriMesh mesh;
  mesh.origin = 0.5 * low + 0.5 * high;
  std::unordered_map<glm::vec3, std::uint32_t, PositionHash> known;
  std::vector<std::uint32_t> joined;
  joined.reserve(soup.positions.size());
  for (const glm::dvec3& p : soup.positions) {
    const glm::vec3 local = glm::vec3(p - mesh.origin) + 0.0f;
    const auto [entry, fresh] = known.try_emplace(local, std::uint32_t(mesh.positions.size()));
    if (fresh) mesh.positions.push_back(local);
    joined.push_back(entry->second);
  }
  for (const auto& [a, b, c] : soup.triangles)
    mesh.triangles.push_back({joined[a], joined[b], joined[c]});
  return mesh;
}

}  // namespace

void fail_to_read(const std::filesystem::path& path, const std::string& what,
                  const std::string& mend) {
  throw Error(concat("cannot read ", path.string(), ": ", what, "; ", mend, "."));
}

TriMesh read_mesh(const std::filesystem::path& path, Faces faces) {
  const std::string extension = extension_of(path);
  const std::string known[] = {".ply", ".obj", ".glb", ".gltf", ".off", ".stl"};
  if (std::find(std::begin(known), std::end(known), extension) == std::end(known))
    fail_to_read(path,
                 extension.empty() ? "it has no extension"
                                   : concat("its extension ", extension, " is not known"),
                 "give a .ply, .obj, .glb, .gltf, .off or .stl file");
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    fail_to_read(path, "it is no file", "check the path");
  if (!std::ifstream(path)) fail_to_read(path, "it cannot be opened", "check its permissions");
  TriMesh mesh;
  if (extension == ".ply") {
    mesh = read_ply(path);
  } else {
    const bool gltf = extension == ".glb" || extension == ".gltf";
    const Soup soup = gltf                  ? read_gltf(path)
                      : extension == ".off" ? read_off(path)
                                            : read_with_assimp(path);
    check_positions(path, soup.positions);
    if (!soup.positions.empty()) mesh = join(soup);
  }
  if (mesh.positions.empty()) fail_to_read(path, "it has no vertices", "give a mesh");
  if (mesh.triangles.empty() && faces == Faces::kNeeded)
    fail_to_read(path, "it has no faces", "give a mesh with faces, not a point cloud");
  return mesh;
}

}  // namespace photohull
