// Dust told from the pieces of thin parts.
#pragma once

#include <span>
#include <vector>

#include "core/grid.h"
#include "gpu/context.h"
#include "refine/silhouette_cones.h"

namespace photohull::refine {

struct DustOptions {
  int least_views = 2;       ///< that only the piece explains, and
  double view_share = 0.15;  ///< their share of all views
};

/// For each small piece of the volume (its voxels): do masks ask for it? They do where at least so
/// many views show, at half of its voxels, foreground that nothing but small pieces covers. That is
/// so of a stem whose pieces lie in a row, and not of a speck before or behind the object.
std::vector<bool> are_asked_for(gpu::Context& context, const SparseVolume& volume,
                                std::span<const std::vector<glm::ivec3>> pieces,
                                const SilhouetteCones& cones, const DustOptions& options);

}  // namespace photohull::refine
