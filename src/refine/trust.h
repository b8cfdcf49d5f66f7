// Where patches cannot be trusted, because they reach beyond the part of the object they lie on.
#pragma once

#include <span>
#include <vector>

#include "core/grid.h"
#include "refine/fit_patches.h"
#include "refine/silhouette_cones.h"
#include "refine/view_choice.h"

namespace photohull::refine {

/// In [0, 1] for surfels with `positions` (voxels) and unit `normals`: the square of the depth of
/// body behind each over `thick` voxels. Patches on thin parts mix in what lies behind, and
/// smoothing makes such parts thinner still.
std::vector<float> trust_thickness(const SparseVolume& volume, std::span<const glm::vec3> positions,
                                   std::span<const glm::vec3> normals, double thick);

/// Multiplies `trust` by the square of the least distance, over the chosen views, of a surfel to
/// the view's outline, where that is below the half edge of its patch. Views without a silhouette
/// do not count.
void trust_outlines(const GridSpec& grid, std::span<const glm::vec3> positions,
                    std::span<const ViewChoice> choices, const SilhouetteCones& cones,
                    const FitOptions& options, std::vector<float>& trust);

}  // namespace photohull::refine
