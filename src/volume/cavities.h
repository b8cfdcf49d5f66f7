// Space that no path from outside reaches.
#pragma once

#include <cstddef>

#include "core/grid.h"

namespace photohull {

/// Makes voxels that are not inside, and that no face-connected path of such voxels joins to the
/// grid's border, part of the body: no camera can have looked in. Returns their number. Time grows
/// with the stored bricks and those outside.
std::size_t fill_cavities(SparseVolume& volume);

}  // namespace photohull
