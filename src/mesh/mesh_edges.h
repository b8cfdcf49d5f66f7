// Private to module mesh: edges and shapes of triangles.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/mesh.h"

namespace photohull {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;
using Corners = std::array<glm::dvec3, 3>;

/// Neighbours whose normals have a smaller dot product are folded onto each other.
constexpr double kFoldCosine = -0.5;
/// Of a triangle, in its longest side: what is lower is degenerate.
constexpr double kLeastHeight = 1e-3;

/// A directed edge of a triangle.
struct Side {
  std::uint32_t from, to, triangle;
  auto operator<=>(const Side&) const = default;
};

inline std::vector<Side> sorted_sides(const Triangles& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t)
    for (int i = 0; i < 3; ++i) sides.push_back({triangles[t][i], triangles[t][(i + 1) % 3], t});
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// The first of the sides that run the other way, or null.
inline const Side* opposite(const std::vector<Side>& sorted, const Side& side) {
  const auto other = std::lower_bound(sorted.begin(), sorted.end(), Side{side.to, side.from, 0});
  const bool found = other != sorted.end() && other->from == side.to && other->to == side.from;
  return found ? &*other : nullptr;
}

inline Corners corners(const TriMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.world(a), mesh.world(b), mesh.world(c)};
}

inline double longest_side(const Corners& p) {
  return std::max(
      {glm::distance(p[0], p[1]), glm::distance(p[1], p[2]), glm::distance(p[2], p[0])});
}

/// Twice the area, along the normal.
inline glm::dvec3 double_area(const Corners& p) { return glm::cross(p[1] - p[0], p[2] - p[0]); }

/// Unit; 0 of a triangle without area.
inline glm::dvec3 unit_normal(const Corners& p) {
  const glm::dvec3 area = double_area(p);
  const double length = glm::length(area);
  return length > 0 ? area / length : glm::dvec3(0);
}

/// Height in the longest side: 0.87 at most.
inline double relative_height(const Corners& p) {
  const double longest = longest_side(p);
  return longest > 0 ? glm::length(double_area(p)) / (longest * longest) : 0;
}

}  // namespace photohull
