// What silhouettes say where photographs say little.
#pragma once

#include <span>
#include <vector>

#include "core/grid.h"
#include "refine/displacement.h"

namespace photohull::refine {

struct RimOptions {
  double weight = 3.0;  ///< of the hull among the peaks, where nothing has texture; 0: none
  double reach = 1.0;   ///< voxels under the hull at which it has lost its say
};

/// Mixes into the peaks of vertices on the hull, or just under it, that they want to lie on it:
/// the less texture a vertex has (Matches::texture) the more it counts. `positions`
/// in voxels of the hull's grid.
void pull_to_hull(const SparseVolume& hull, std::span<const glm::vec3> positions,
                  std::span<const float> texture, const RimOptions& options,
                  std::vector<Peak>& peaks);

}  // namespace photohull::refine
