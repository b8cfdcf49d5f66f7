// The voxel lattice and sparse volumes on it.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/box.h"

namespace photohull {

inline constexpr int kBrickEdge = 8;      ///< voxels along a brick's edge, as an OpenVDB leaf's
inline constexpr int kBrickVoxels = 512;  ///< voxels in a brick

/// A lattice of cubic voxels in bricks of 8^3. Voxel (i, j, k) has its centre at
/// origin + voxel_size * (i, j, k); all indices are >= 0.
struct GridSpec {
  glm::dvec3 origin{0.0};  ///< world position of the centre of voxel (0, 0, 0)
  double voxel_size = 0;   ///< world units
  glm::ivec3 bricks{0};    ///< bricks along each axis
  /// Of a part of a larger lattice: how many of that one's voxels lie before and after it. Only
  /// frame() goes by them.
  glm::dvec3 before{0.0}, after{0.0};

  glm::ivec3 voxels() const { return bricks * kBrickEdge; }
  glm::dvec3 world(const glm::dvec3& voxel) const { return origin + voxel_size * voxel; }
  /// The larger lattice, from the centre of its first voxel to that of its last, in voxels of this
  /// one. What follows from how cameras look at it is the same for all parts.
  Box frame() const { return {-before, glm::dvec3(voxels() - 1) + after}; }
  /// The world box that the voxels (not only their centres) fill.
  Box bounds() const;
  std::size_t brick_count() const {
    return std::size_t(bricks.x) * std::size_t(bricks.y) * std::size_t(bricks.z);
  }
  std::size_t brick_index(const glm::ivec3& b) const {
    return (std::size_t(b.z) * bricks.y + b.y) * bricks.x + b.x;
  }
};

/// Index of a voxel within its brick: x slowest, z fastest, as in an OpenVDB leaf.
inline int voxel_offset(const glm::ivec3& local) {
  return (local.x << 6) | (local.y << 3) | local.z;
}

/// A truncated signed distance on bricks near the surface; what is not stored is known to lie
/// inside or outside. Distances are in voxels, negative inside, clamped to [-kBand, kBand].
struct SparseVolume {
  static constexpr float kBand = 3.0f;  ///< voxels
  static constexpr std::uint32_t kOutside = 0xffffffffu;
  static constexpr std::uint32_t kInside = 0xfffffffeu;

  GridSpec grid;
  std::vector<std::uint32_t> table;  ///< per brick of the grid: a slot, kOutside or kInside
  std::vector<glm::ivec3> bricks;    ///< brick coordinates of each slot
  std::vector<float> distance;       ///< kBrickVoxels per slot, in voxel_offset order

  /// Value at a voxel of the grid; outside the grid it is +kBand.
  float at(const glm::ivec3& voxel) const;
  /// Trilinear interpolation of at(), at a point in voxel coordinates.
  double interpolated(const glm::dvec3& p) const;
  /// Number of voxels with negative distance, unstored inside bricks included.
  std::size_t inside_voxels() const;
};

}  // namespace photohull
