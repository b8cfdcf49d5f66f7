// What a surface of the moment before is good for.
#pragma once

#include "core/describe.h"
#include "core/grid.h"

namespace photohull::refine {

/// The surface a moment ago, on any grid, of what may have moved by some voxels since.
struct MomentBefore {
  SparseVolume surface;
  bool followed = false;  ///< was it found from the surface of a moment before, in its turn?
};

struct FollowOptions {
  int levels = 2, again_levels = 1;
  double least_inside = 0.6, again_least_near = 0.97;
};

inline void describe(Described& to, FollowOptions& o) {
  to.number("levels", &o.levels, from_to(1, 8), "",
            "the last levels, which alone are done where the surface of the moment before serves");
  to.number("least_inside", &o.least_inside, from_to(0, 1), "",
            "share of what was solid that must lie in the hull of now for that surface to serve");
  to.number("again_levels", &o.again_levels, from_to(1, 8), "",
            "the last levels where that surface was found in this way, too, and has hardly moved");
  to.number("again_least_near", &o.again_least_near, from_to(0, 1), "",
            "share of what was solid that must not have moved out of the hull by more than a voxel "
            "of the first of follow.levels");
}

/// How many of the last levels are to be done from the moment before; 0: too much of what was solid
/// lies elsewhere, or nothing was, so that it does not serve. `hull`: of now, on the grid of the
/// first of `options.levels`.
int levels_from(const MomentBefore& before, const SparseVolume& hull, const FollowOptions& options);

}  // namespace photohull::refine
