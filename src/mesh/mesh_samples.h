// Private to module mesh: points spread over triangles.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

namespace photohull {

/// Calls `use(point)` for points of a triangle about `spacing` apart: rows along its longest edge.
template <typename Use>
void for_points(const std::array<glm::dvec3, 3>& corners, double spacing, Use&& use) {
  int first = 0;
  double longest = 0;
  for (int i = 0; i < 3; ++i) {
    const double length = glm::distance(corners[i], corners[(i + 1) % 3]);
    if (!(length > longest)) continue;
    longest = length;
    first = i;
  }
  if (!(longest > 0)) return;
  const glm::dvec3 &a = corners[first], &b = corners[(first + 1) % 3],
                   &apex = corners[(first + 2) % 3];
  const double height = glm::length(glm::cross(b - a, apex - a)) / longest;
  const auto parts = [&](double length) {
    return std::clamp(int(std::ceil(length / spacing)), 1, 4096);
  };
  const int rows = parts(height);
  for (int row = 0; row < rows; ++row) {
    // The last row is a triangle, whose middle is at a third of its height.
    const double up = (row + (row + 1 == rows ? 1.0 / 3 : 0.5)) / rows;
    const glm::dvec3 from = glm::mix(a, apex, up), to = glm::mix(b, apex, up);
    const int columns = parts((1 - up) * longest);
    for (int column = 0; column < columns; ++column)
      use(glm::mix(from, to, (column + 0.5) / columns));
  }
}

/// Calls `use(point)` for points between two, at most `spacing` apart.
template <typename Use>
void for_edge_points(const glm::dvec3& from, const glm::dvec3& to, double spacing, Use&& use) {
  const int parts = std::clamp(int(std::ceil(glm::distance(from, to) / spacing)), 1, 4096);
  for (int part = 0; part < parts; ++part) use(glm::mix(from, to, (part + 0.5) / parts));
}

}  // namespace photohull
