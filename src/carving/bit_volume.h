// Which voxels stand, as bits: the state that the sweeps carve.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.h"

namespace photohull::carving {

/// One bit a voxel for every brick that is stored or wholly inside; 16 words a brick, in the order
/// of voxel_offset.
struct BitVolume {
  static constexpr int kWords = kBrickVoxels / 32;

  GridSpec grid;
  std::vector<std::uint32_t> table;  ///< per brick of the grid: a slot or SparseVolume::kOutside
  std::vector<glm::ivec3> bricks;    ///< brick coordinates of each slot
  std::vector<std::uint32_t> words;  ///< kWords per slot

  bool standing(const glm::ivec3& voxel) const;
  void clear(const glm::ivec3& voxel);  ///< the voxel must stand
};

BitVolume to_bits(const SparseVolume& volume);

/// Distance of what is left: `hull`'s own where nothing was carved within reach; elsewhere the
/// greater of that and a smooth distance to the carved surface, whose sign agrees with the bits.
SparseVolume carved_distance(const SparseVolume& hull, const BitVolume& bits);

}  // namespace photohull::carving
