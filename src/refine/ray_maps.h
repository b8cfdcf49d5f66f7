// Private to module refine: coarse depth maps of the views.
#pragma once

#include <span>
#include <vector>

#include "core/grid.h"
#include "gpu/context.h"
#include "projtex/image_set.h"
#include "refine/vote.h"

namespace photohull::refine {

/// Rays of one view on a lattice of pixels, each with what it found.
struct RayMap {
  double stride = 1;  ///< pixels between rays
  int width = 0, height = 0;
  std::vector<float> depth;   ///< voxels along the optical axis, row-major
  std::vector<float> weight;  ///< [0, 1]; 0: the ray says nothing
};

/// For every view, the depths at which its rays through the hull agree best with views near it.
std::vector<RayMap> match_rays(gpu::Context& context, const SparseVolume& hull,
                               const projtex::ImageSet& images, std::span<const Camera> cameras,
                               double noise_sigma, const VoteOptions& options);

}  // namespace photohull::refine
