// Parts of the visual hull that coarse voxels lost and silhouettes prove.
#pragma once

#include <span>

#include "carving/hull.h"
#include "core/grid.h"
#include "gpu/context.h"

namespace photohull::refine {

struct RestoreOptions {
  int least_views = 3;        ///< in which nothing else explains the pixel
  double least_inside = 0.3;  ///< pixels within the silhouette
  double least_away = 1.5;    ///< voxels that a part must reach away from the volume
};

/// The volume with every voxel of `hull` (on the same grid) that falls on a foreground pixel which
/// the volume does not cover, in at least `least_views` views. Returns how many came back.
std::size_t restore_silhouettes(gpu::Context& context, SparseVolume& volume,
                                const SparseVolume& hull, std::span<const Camera> cameras,
                                std::span<const carving::Silhouette> silhouettes,
                                const RestoreOptions& options);

}  // namespace photohull::refine
