// Volumes on one grid combined.
#pragma once

#include "core/grid.h"

namespace photohull {

/// What lies in both: the greater of the two distances. The grids must be equal.
SparseVolume intersection(const SparseVolume& a, const SparseVolume& b);
/// What lies in either: the lesser of the two distances. The grids must be equal.
SparseVolume union_of(const SparseVolume& a, const SparseVolume& b);

}  // namespace photohull
