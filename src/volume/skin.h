// The voxels that a surface passes beside, on its inner side.
#pragma once

#include <vector>

#include "core/grid.h"

namespace photohull {

/// Stored voxels on the surface or less than a voxel inside, brick by brick.
std::vector<glm::ivec3> skin(const SparseVolume& volume);

}  // namespace photohull
