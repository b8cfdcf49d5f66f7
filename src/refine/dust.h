// Dust told from the pieces of thin parts.
#pragma once

#include <span>
#include <vector>

#include "carving/hull.h"
#include "core/grid.h"
#include "gpu/context.h"

namespace photohull::refine {

struct DustOptions {
  int least_views = 2;       ///< that only the piece explains, and
  double view_share = 0.15;  ///< their share of all views
};

/// For each small piece of the volume (its voxels): do masks ask for it? They do where at least so
/// many views show, at half of its voxels, foreground that nothing but small pieces covers. That is
/// so of a stem whose pieces lie in a row, and not of a speck before or behind the object.
/// `silhouettes`: one for each camera, parts may be empty.
std::vector<bool> are_asked_for(gpu::Context& context, const SparseVolume& volume,
                                std::span<const std::vector<glm::ivec3>> pieces,
                                std::span<const Camera> cameras,
                                std::span<const carving::Silhouette> silhouettes,
                                const DustOptions& options);

}  // namespace photohull::refine
