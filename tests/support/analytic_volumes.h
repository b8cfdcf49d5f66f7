// Volumes with known surfaces, and checks of meshes against them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <utility>

#include "core/grid.h"
#include "core/mesh.h"

namespace photohull {

/// Signed distance at a position, both in voxels.
using Distance = std::function<double(const glm::dvec3&)>;

/// Samples a distance on a grid of bricks; bricks without a voxel in the band are not stored.
inline SparseVolume sample_volume(const glm::ivec3& bricks, const Distance& distance,
                                  const glm::dvec3& origin = glm::dvec3(0), double voxel_size = 1) {
  SparseVolume volume;
  volume.grid = {origin, voxel_size, bricks};
  for (int z = 0; z < bricks.z; ++z)
    for (int y = 0; y < bricks.y; ++y)
      for (int x = 0; x < bricks.x; ++x) {
        const glm::ivec3 brick(x, y, z);
        std::array<float, kBrickVoxels> values;
        for (int i = 0; i < kBrickVoxels; ++i) {
          const glm::ivec3 voxel = brick * kBrickEdge + glm::ivec3(i >> 6, (i >> 3) & 7, i & 7);
          values[i] = std::clamp(float(distance(glm::dvec3(voxel))), -SparseVolume::kBand,
                                 SparseVolume::kBand);
        }
        const auto [low, high] = std::minmax_element(values.begin(), values.end());
        if (*low >= SparseVolume::kBand) {
          volume.table.push_back(SparseVolume::kOutside);
        } else if (*high <= -SparseVolume::kBand) {
          volume.table.push_back(SparseVolume::kInside);
        } else {
          volume.table.push_back(std::uint32_t(volume.bricks.size()));
          volume.bricks.push_back(brick);
          volume.distance.insert(volume.distance.end(), values.begin(), values.end());
        }
      }
  return volume;
}

inline Distance sphere(const glm::dvec3& center, double radius) {
  return [=](const glm::dvec3& p) { return glm::length(p - center) - radius; };
}

/// A torus around the z axis through `center`.
inline Distance torus(const glm::dvec3& center, double ring, double tube) {
  return [=](const glm::dvec3& p) {
    const glm::dvec3 d = p - center;
    return std::hypot(std::hypot(d.x, d.y) - ring, d.z) - tube;
  };
}

inline Distance box(const glm::dvec3& low, const glm::dvec3& high) {
  return [=](const glm::dvec3& p) {
    const glm::dvec3 q = glm::abs(p - 0.5 * (low + high)) - 0.5 * (high - low);
    return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0);
  };
}

/// Directed edges that are not matched by exactly one opposite edge; 0 for a closed manifold.
inline std::size_t open_edges(const TriMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<int, int>> edges;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      if (a < b)
        ++edges[{a, b}].first;
      else
        ++edges[{b, a}].second;
    }
  std::size_t open = 0;
  for (const auto& [edge, uses] : edges) open += uses != std::pair{1, 1};
  return open;
}

/// Volume inside the mesh; positive when its triangles are counter-clockwise from outside.
inline double signed_volume(const TriMesh& mesh) {
  double six_times = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    six_times += glm::dot(glm::dvec3(mesh.positions[a]),
                          glm::cross(glm::dvec3(mesh.positions[b]), glm::dvec3(mesh.positions[c])));
  return six_times / 6;
}

inline double smallest_area(const TriMesh& mesh) {
  double smallest = 1e300;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 p(mesh.positions[a]), q(mesh.positions[b]), r(mesh.positions[c]);
    smallest = std::min(smallest, 0.5 * glm::length(glm::cross(q - p, r - p)));
  }
  return smallest;
}

}  // namespace photohull
