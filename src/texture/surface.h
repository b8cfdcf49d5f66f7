// Private to module texture: triangles and what lies beside them.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/mesh.h"

namespace photohull::texture {

inline constexpr std::uint32_t kNoFace = 0xffffffffu;

/// For each triangle, the one across each of its sides (from corner i to corner i + 1); kNoFace
/// where there is none, or where more than two triangles meet.
std::vector<std::array<std::uint32_t, 3>> neighbours_of(const TriMesh& mesh);

/// Twice the area, along the normal, world units.
inline glm::dvec3 double_area(const TriMesh& mesh, std::size_t face) {
  const auto& [a, b, c] = mesh.triangles[face];
  const glm::dvec3 p(mesh.positions[a]);
  return glm::cross(glm::dvec3(mesh.positions[b]) - p, glm::dvec3(mesh.positions[c]) - p);
}

/// Root of linear light, in which noise is about even.
inline glm::vec3 root_of(const glm::vec3& linear) {
  return glm::sqrt(glm::max(linear, glm::vec3(0)));
}

}  // namespace photohull::texture
