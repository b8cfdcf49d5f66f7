// The triangles of a glTF file's scene.
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "io/mesh/gltf_file.h"
#include "io/mesh/mesh_soup.h"

namespace photohull {
namespace {

using Json = nlohmann::json;

enum Mode : std::uint64_t { kTriangles = 4, kStrip = 5, kFan = 6 };

glm::dmat4 local_transform(const GltfFile& file, const Json& node) {
  glm::dmat4 transform(1);
  if (const auto m = file.numbers(node, "matrix", 16); !m.empty()) {
    for (int i = 0; i < 16; ++i) transform[i / 4][i % 4] = m[i];
    return transform;
  }
  if (const auto t = file.numbers(node, "translation", 3); !t.empty())
    transform = glm::translate(transform, glm::dvec3(t[0], t[1], t[2]));
  if (const auto q = file.numbers(node, "rotation", 4); !q.empty())  // x y z w
    transform *= glm::mat4_cast(glm::dquat(q[3], q[0], q[1], q[2]));
  if (const auto s = file.numbers(node, "scale", 3); !s.empty())
    transform = glm::scale(transform, glm::dvec3(s[0], s[1], s[2]));
  return transform;
}

void add_triangles(const GltfFile& file, const std::vector<std::uint32_t>& corners,
                   std::uint64_t mode, bool mirrored, std::size_t first, Soup& soup) {
  constexpr std::size_t kMostTriangles = 1u << 29;  // also what instances of meshes add up to
  const std::size_t vertices = soup.positions.size() - first;
  if (soup.triangles.size() + corners.size() > kMostTriangles)
    file.fail("it has more than 536 million triangles");
  for (const std::uint32_t corner : corners)
    if (corner >= vertices)
      file.fail(concat("an index is out of range: ", corner, " of ", vertices, " vertices"));
  const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
    if (mirrored) std::swap(b, c);
    soup.triangles.push_back({std::uint32_t(first + corners[a]), std::uint32_t(first + corners[b]),
                              std::uint32_t(first + corners[c])});
  };
  const std::size_t step = mode == kTriangles ? 3 : 1;
  for (std::size_t i = 2; i < corners.size(); i += step)
    if (mode == kFan)
      add(0, i - 1, i);
    else if (mode == kStrip && i % 2 == 1)
      add(i - 1, i - 2, i);
    else
      add(i - 2, i - 1, i);
}

void add_mesh(GltfFile& file, const Json& mesh, const glm::dmat4& world, Soup& soup) {
  constexpr std::size_t kMostVertices = 1u << 28;
  const bool mirrored = glm::determinant(glm::dmat3(world)) < 0;
  const auto primitives = mesh.find("primitives");
  if (primitives == mesh.end() || !primitives->is_array()) file.fail("a mesh has no primitives");
  for (const Json& primitive : *primitives) {
    if (!primitive.is_object()) file.fail("a primitive is no object");
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object() ||
        !attributes->contains("POSITION"))
      continue;
    const std::size_t first = soup.positions.size();
    const std::vector<glm::vec3> positions = file.vectors(file.index(*attributes, "POSITION"));
    if (first + positions.size() > kMostVertices)
      file.fail("it has more than 268 million vertices");
    for (const glm::vec3& p : positions)
      soup.positions.emplace_back(world * glm::dvec4(glm::dvec3(p), 1));
    const std::uint64_t mode = file.index(primitive, "mode", kTriangles);
    if (mode < kTriangles || mode > kFan) continue;  // points and lines
    std::vector<std::uint32_t> corners;
    if (primitive.contains("indices")) {
      corners = file.integers(file.index(primitive, "indices"));
    } else {
      corners.resize(positions.size());
      std::iota(corners.begin(), corners.end(), 0u);
    }
    add_triangles(file, corners, mode, mirrored, first, soup);
  }
}

}  // namespace

Soup read_gltf(const std::filesystem::path& path) {
  GltfFile file(path);
  Soup soup;
  const auto list_size = [&](const char* list) {
    const auto found = file.root().find(list);
    return found != file.root().end() && found->is_array() ? found->size() : 0;
  };
  if (list_size("scenes") == 0) {
    for (std::size_t i = 0; i < list_size("meshes"); ++i)
      add_mesh(file, file.element("meshes", i), glm::dmat4(1), soup);
    return soup;
  }
  std::vector<std::pair<std::uint64_t, glm::dmat4>> open;
  for (const std::uint64_t node :
       file.indices(file.element("scenes", file.index(file.root(), "scene", 0)), "nodes"))
    open.emplace_back(node, glm::dmat4(1));
  std::vector<bool> seen(list_size("nodes"));
  while (!open.empty()) {
    const auto [index, parent] = open.back();
    open.pop_back();
    const Json& node = file.element("nodes", index);
    if (seen[index]) file.fail(concat("nodes[", index, "] has several parents"));
    seen[index] = true;
    const glm::dmat4 world = parent * local_transform(file, node);
    if (node.contains("mesh"))
      add_mesh(file, file.element("meshes", file.index(node, "mesh")), world, soup);
    for (const std::uint64_t child : file.indices(node, "children"))
      open.emplace_back(child, world);
  }
  return soup;
}

}  // namespace photohull
