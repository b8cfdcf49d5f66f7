// Surfels matched in photographs that are held all at once or a few at a time; private to module
// refine.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "core/grid.h"
#include "gpu/context.h"
#include "refine/kernels/match_patches.h"
#include "refine/match.h"
#include "refine/matching_photographs.h"
#include "refine/view_choice.h"

namespace photohull::refine {

/// What is asked of surfels.
struct MatchRequest {
  MatchOptions options;
  OffsetRange range;
  bool textures_alone = false;  ///< Matches::texture and samples: nothing is compared
};

/// Surfels in voxels of a grid, as their owner has them.
struct SurfelsAsked {
  std::function<PatchSurfel(std::uint32_t)> at;
  std::span<const glm::vec3> bends;     ///< one a surfel; empty: their patches are planes
  std::span<const ViewChoice> choices;  ///< one a surfel
};

/// Matches those that are comparable, some of them after the others: PatchMatcher::match and
/// textures. Of the others nothing is known.
Matches match_surfels(gpu::Context& context, const MatchingPhotographs& photographs,
                      const GridSpec& grid, const SurfelsAsked& surfels,
                      const MatchRequest& request);

}  // namespace photohull::refine
