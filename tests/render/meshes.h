// Meshes for the tests of rendering.
#pragma once

#include <cmath>

#include "core/mesh.h"

namespace photohull::test {

/// A sphere of `rings` parallels and twice as many meridians, at `centre` (also the mesh's origin).
inline TriMesh sphere_mesh(const glm::dvec3& centre, double radius, int rings) {
  constexpr double kPi = 3.14159265358979323846;
  TriMesh mesh;
  mesh.origin = centre;
  const int columns = 2 * rings;
  for (int i = 0; i <= rings; ++i)
    for (int j = 0; j <= columns; ++j) {
      const double polar = kPi * i / rings, azimuth = 2 * kPi * j / columns;
      const glm::dvec3 n(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                         std::cos(polar));
      mesh.normals.emplace_back(n);
      mesh.positions.emplace_back(radius * n);
    }
  const auto at = [&](int i, int j) { return std::uint32_t(i * (columns + 1) + j); };
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < columns; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

/// Adds a square plate in the plane z, facing -z, of side 2 * half about (x, y), vertices `step`
/// apart.
inline void add_plate(double x, double y, double z, double half, double step, TriMesh& mesh) {
  const int n = int(std::lround(2 * half / step));
  const auto first = std::uint32_t(mesh.positions.size());
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) {
      mesh.positions.emplace_back(x - half + j * step, y - half + i * step, z);
      mesh.normals.emplace_back(0, 0, -1);
    }
  const auto at = [&](int i, int j) { return first + std::uint32_t(i * (n + 1) + j); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
}

}  // namespace photohull::test
