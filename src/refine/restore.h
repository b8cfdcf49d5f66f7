// Thin parts that coarse voxels lost and silhouettes prove.
#pragma once

#include <span>

#include "core/describe.h"
#include "core/grid.h"
#include "gpu/context.h"
#include "refine/silhouette_cones.h"

namespace photohull::refine {

struct RestoreOptions {
  int least_views = 2;
  double least_inside = 0, most_before = 3;
};

inline void describe(Described& to, RestoreOptions& o) {
  to.number("least_views", &o.least_views, at_least(1), "",
            "views that show foreground where the volume covers none, for a part to come back");
  to.number("least_inside", &o.least_inside, from_to(0, 1000), "pixels",
            "distance within the silhouette that such foreground must have");
  to.number(
      "most_before", &o.most_before, at_least(0), "",
      "views in which a part may hide what lies behind, for each that shows foreground there");
}

/// Brings back the voxels of `hull` (on the same grid) that fall, in at least `least_views` views,
/// on foreground that the volume does not cover, unless they would hide, in many more views, what
/// of the volume lies behind them. Returns how many came back.
std::size_t restore_silhouettes(gpu::Context& context, SparseVolume& volume,
                                const SparseVolume& hull, const SilhouetteCones& cones,
                                const RestoreOptions& options);

}  // namespace photohull::refine
