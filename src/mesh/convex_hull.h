// Convex hulls of points.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace photohull {

/// Triangles of the surface of the least convex solid that holds the points, by their indices,
/// counter-clockwise seen from outside; none where the points lie in a plane. By Qhull
/// [Barber96]. Throws where Qhull gives up.
std::vector<std::array<std::uint32_t, 3>> convex_hull(std::span<const glm::dvec3> points);

}  // namespace photohull
