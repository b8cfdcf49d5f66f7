// Sets of voxels as sorted lists; private to module refine.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/grid.h"

namespace photohull::refine {

/// Voxels by their place in the lattice, x fastest.
class Lattice {
 public:
  explicit Lattice(const GridSpec& grid) : Lattice(grid.voxels()) {}
  explicit Lattice(const glm::ivec3& voxels) : n_(voxels) {}
  bool contains(const glm::ivec3& v) const {
    return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < n_.x && v.y < n_.y && v.z < n_.z;
  }
  std::uint64_t index(const glm::ivec3& v) const {
    return (std::uint64_t(v.z) * std::uint64_t(n_.y) + std::uint64_t(v.y)) * std::uint64_t(n_.x) +
           std::uint64_t(v.x);
  }
  glm::ivec3 voxel(std::uint64_t i) const {
    const auto x = std::uint64_t(n_.x), y = std::uint64_t(n_.y);
    return {int(i % x), int(i / x % y), int(i / x / y)};
  }

 private:
  glm::ivec3 n_;
};

using VoxelSet = std::vector<std::uint64_t>;

constexpr std::size_t kVoxelSetPart = 1024;  // lines or points that a task takes

/// All parts in one sorted list; what comes more than once stays so.
VoxelSet sorted(const std::vector<VoxelSet>& parts);

/// The voxels nearest to the points, with their 26 neighbours, each once.
VoxelSet around(std::span<const glm::vec3> points, const GridSpec& grid);
/// The same of points in several lists, some at a time: calls take(part) for parts that follow each
/// other.
void for_around(std::span<const std::span<const glm::vec3>> points, const GridSpec& grid,
                const std::function<void(const VoxelSet&)>& take);

bool contains(const VoxelSet& set, std::uint64_t index);

/// The voxel's place in `volume.distance`; its brick is stored from now on.
float& stored(const glm::ivec3& voxel, SparseVolume& volume);

inline glm::ivec3 nearest_voxel(const glm::dvec3& p) { return glm::ivec3(glm::floor(p + 0.5)); }

/// Calls f(voxel) for a voxel and its 26 neighbours, as far as they lie in the lattice.
template <typename F>
void for_block(const Lattice& lattice, const glm::ivec3& middle, F&& f) {
  for (int i = 0; i < 27; ++i) {
    const glm::ivec3 voxel = middle + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    if (lattice.contains(voxel)) f(voxel);
  }
}

}  // namespace photohull::refine
