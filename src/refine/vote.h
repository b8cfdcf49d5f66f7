// Free space by voting of coarse depth maps.
#pragma once

#include <span>

#include "core/grid.h"
#include "gpu/context.h"
#include "projtex/image_set.h"

namespace photohull::refine {

struct VoteOptions {
  double ray_spacing = 1.0;  ///< voxels
  double tap_spacing = 0.7;  ///< voxels
  double best_pairs = 0.5;
  double least_score = 0.5;
  double distinct_by = 0.15;
  double band = 1.5;  ///< voxels
  double least_weight = 0.3;
  int smoothing = 0;
};

/// The hull without what the views' depth maps see through.
SparseVolume vote_free_space(gpu::Context& context, const SparseVolume& hull,
                             const projtex::ImageSet& images, std::span<const Camera> cameras,
                             double noise_sigma, const VoteOptions& options);

}  // namespace photohull::refine
