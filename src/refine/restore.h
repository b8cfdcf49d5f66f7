// Thin parts that coarse voxels lost and silhouettes prove.
#pragma once

#include <span>

#include "carving/hull.h"
#include "core/grid.h"
#include "gpu/context.h"

namespace photohull::refine {

struct RestoreOptions {
  int least_views = 2;      ///< that show foreground there which the volume does not cover
  double least_inside = 0;  ///< pixels within the silhouette
  double most_before = 3;   ///< views in which it would hide what lies behind, for each of those
};

/// Brings back the voxels of `hull` (on the same grid) that fall, in at least `least_views` views,
/// on foreground that the volume does not cover, unless they would hide, in many more views, what
/// of the volume lies behind them. Returns how many came back.
std::size_t restore_silhouettes(gpu::Context& context, SparseVolume& volume,
                                const SparseVolume& hull, std::span<const Camera> cameras,
                                std::span<const carving::Silhouette> silhouettes,
                                const RestoreOptions& options);

}  // namespace photohull::refine
