// What a surface of the moment before is good for.
#pragma once

#include "core/describe.h"
#include "core/grid.h"

namespace photohull::refine {

struct FollowOptions {
  int levels = 2;
  double least_inside = 0.6;
};

inline void describe(Described& to, FollowOptions& o) {
  to.number("levels", &o.levels, from_to(1, 8), "",
            "the last levels, which alone are done where the surface of the moment before serves");
  to.number("least_inside", &o.least_inside, from_to(0, 1), "",
            "share of what was solid that must lie in the hull of now for that surface to serve");
}

/// Does enough of what was solid a moment before lie in the hull of now, so that the surface of now
/// can be found from that one? `before` may be on any grid; one that is empty does not.
bool resembles(const SparseVolume& before, const SparseVolume& hull, const FollowOptions& options);

}  // namespace photohull::refine
