#include "io/mesh/split_mesh.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/error.h"

namespace photohull {
namespace {

/// A corner of a triangle.
struct Corner {
  std::uint32_t vertex;
  glm::vec2 place;
  std::uint32_t triangle;  // of the part
  int index;

  auto key() const { return std::tuple(vertex, place.x, place.y); }
};

MeshPart part_of(std::vector<Corner> corners, bool places) {
  std::stable_sort(corners.begin(), corners.end(),
                   [](const Corner& a, const Corner& b) { return a.key() < b.key(); });
  MeshPart part;
  part.triangles.resize(corners.size() / 3);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (i == 0 || corners[i].key() != corners[i - 1].key()) {
      part.vertices.push_back(corners[i].vertex);
      if (places) part.places.push_back(corners[i].place);
    }
    part.triangles[corners[i].triangle][std::size_t(corners[i].index)] =
        std::uint32_t(part.vertices.size() - 1);
  }
  return part;
}

}  // namespace

std::vector<MeshPart> split_by_pages(const MeshContents& contents) {
  const TriMesh& mesh = contents.mesh;
  const MeshTexture* texture = contents.texture;
  if (texture) {
    PHOTOHULL_CHECK_OP(texture->page.size(), ==, mesh.triangles.size());
    PHOTOHULL_CHECK_OP(texture->corners.size(), ==, mesh.triangles.size());
  }
  std::vector<std::vector<Corner>> corners(texture ? texture->pages.size() : 1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    std::vector<Corner>& part = corners[texture ? texture->page[t] : 0];
    const std::uint32_t triangle = std::uint32_t(part.size() / 3);
    for (int i = 0; i < 3; ++i)
      part.push_back({mesh.triangles[t][std::size_t(i)],
                      texture ? texture->corners[t][std::size_t(i)] : glm::vec2(0), triangle, i});
  }
  std::vector<MeshPart> parts;
  for (std::vector<Corner>& part : corners)
    parts.push_back(part_of(std::move(part), texture != nullptr));
  return parts;
}

glm::dmat3 y_up_from_world(const glm::dvec3& up) {
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (std::abs(up[i]) > std::abs(up[axis])) axis = i;
  const double sign = up[axis] < 0 ? -1 : 1;
  // Rows: the new x, y and z. For +z that is x, z, -y; for +y nothing changes.
  glm::dvec3 y(0), x(0);
  y[axis] = sign;
  x[axis == 0 ? 1 : 0] = axis == 0 ? -sign : 1;
  const glm::dvec3 z = glm::cross(x, y);
  return glm::transpose(glm::dmat3(x, y, z));
}

glm::vec3 unit_normal(const TriMesh& mesh, std::size_t vertex) {
  const glm::vec3 normal = mesh.normals.empty() ? glm::vec3(0) : mesh.normals[vertex];
  const float length = glm::length(normal);
  return length > 0.5f && length < 2 ? normal / length : glm::vec3(0, 0, 1);
}

std::string page_name(const AtomicFile& file, std::size_t page, TextureFormat format) {
  return concat(file.target().stem().string(), "_", page, ".", extension_of(format));
}

}  // namespace photohull
