// Connected parts of the body in a volume.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/grid.h"

namespace photohull {

/// Voxel counts of the connected components of the voxels with negative distance, largest first;
/// unstored inside bricks count with all their voxels. Voxels that share a face, an edge or a
/// corner are connected, so that thin diagonal structures hold together. Time grows with the
/// number of stored and inside bricks.
std::vector<std::size_t> component_sizes(const SparseVolume& volume);

struct RemovedComponents {
  std::size_t components = 0;
  std::size_t voxels = 0;
};

/// Says of each small component, given by its voxels, whether it is wanted all the same.
using AreWanted = std::function<std::vector<bool>(std::span<const std::vector<glm::ivec3>>)>;

/// Drops the components with fewer voxels than `fraction` of the largest one's: their voxels, and
/// the positive distances around them that no kept component is near, become +kBand. Bricks stay
/// stored. `are_wanted` is asked once, if there are any. Throws UsageError when fraction is not in
/// [0, 1].
RemovedComponents remove_small_components(SparseVolume& volume, double fraction,
                                          const AreWanted& are_wanted = {});

}  // namespace photohull
