// Parts of a volume joined by the fewest voxels.
#pragma once

#include <span>
#include <vector>

#include "core/grid.h"

namespace photohull::carving {

/// A voxel outside the volume that may be put into it.
struct Joint {
  glm::ivec3 voxel{0};
  float distance = 0;  ///< that it would get, below 0: the deeper, the sooner it is taken
};

/// Which of the joints lie on paths between parts of the volume that do not hang together beside
/// them: their indices, rising. Paths are those of the deepest joints, as in Kruskal's spanning
/// tree, and at most some voxels long.
std::vector<std::size_t> find_joining(const SparseVolume& volume, std::span<const Joint> joints);

/// Puts a joint into the volume. Its brick must be there.
void put(const Joint& joint, SparseVolume& volume);

}  // namespace photohull::carving
