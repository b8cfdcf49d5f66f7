// Bricks to the leaves of an OpenVDB tree; private to this module. A template, so that OpenVDB's
// headers stay in the .cpp files that include it.
#pragma once

#include <cstddef>
#include <type_traits>
#include <utility>

#include "core/grid.h"

namespace photohull {

/// Fills an empty tree: stored bricks become leaves, kInside bricks inactive leaf-sized tiles.
/// `value(distance)` and `active(distance)` tell a voxel's value and state from its distance in
/// voxels. `Leaf` is the tree's leaf type; `accessor` writes to the tree.
template <typename Leaf, typename Accessor, typename Value, typename Active>
void fill_tree(const SparseVolume& volume, Accessor&& accessor, Value value, Active active) {
  using Coord = std::decay_t<decltype(std::declval<Leaf>().origin())>;
  for (std::size_t slot = 0; slot < volume.bricks.size(); ++slot) {
    const glm::ivec3 corner = volume.bricks[slot] * kBrickEdge;
    const float* distance = volume.distance.data() + slot * kBrickVoxels;
    auto* leaf = new Leaf(Coord(corner.x, corner.y, corner.z), value(SparseVolume::kBand), false);
    float* values = leaf->buffer().data();
    auto mask = leaf->valueMask();
    for (int i = 0; i < kBrickVoxels; ++i) {
      values[i] = value(distance[i]);
      if (active(distance[i])) mask.setOn(i);
    }
    leaf->setValueMask(mask);
    accessor.addLeaf(leaf);  // The tree owns it now.
  }
  std::size_t index = 0;
  for (int z = 0; z < volume.grid.bricks.z; ++z)
    for (int y = 0; y < volume.grid.bricks.y; ++y)
      for (int x = 0; x < volume.grid.bricks.x; ++x)
        if (volume.table[index++] == SparseVolume::kInside)
          accessor.addTile(1, Coord(x, y, z) << 3, value(-SparseVolume::kBand), false);
}

}  // namespace photohull
