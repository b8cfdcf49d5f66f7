// What a surface of the moment before is good for.
#pragma once

#include "core/grid.h"

namespace photohull::refine {

/// Does most of what was solid a moment before lie in the hull of now, so that the surface of now
/// can be found from that one? `before` may be on any grid.
bool resembles(const SparseVolume& before, const SparseVolume& hull);

}  // namespace photohull::refine
