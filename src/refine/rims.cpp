// Rims of silhouettes as a constraint on the surface [Furukawa09].
#include "refine/rims.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace photohull::refine {

void pull_to_hull(const SparseVolume& hull, std::span<const glm::vec3> positions,
                  std::span<const float> texture, const RimOptions& options,
                  std::vector<Peak>& peaks) {
  tbb::parallel_for(std::size_t(0), peaks.size(), [&](std::size_t i) {
    const float under = float(-hull.interpolated(glm::dvec3(positions[i])));
    const float share = 1 - std::clamp(under, 0.0f, float(options.reach)) / float(options.reach);
    Peak& peak = peaks[i];
    const float weight = float(options.weight) * share * (1 - texture[i]);
    if (!(weight > 0)) return;
    peak.offset = (peak.weight * peak.offset + weight * under) / (peak.weight + weight);
    peak.weight += weight;
  });
}

}  // namespace photohull::refine
