// Rims of silhouettes as a constraint on the surface [Furukawa09].
#include "refine/rims.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace photohull::refine {
namespace {

/// Trilinear interpolation.
float distance_at(const SparseVolume& volume, const glm::vec3& p) {
  const glm::vec3 low = glm::floor(p), share = p - low;
  float sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 step(corner & 1, (corner >> 1) & 1, corner >> 2);
    const glm::vec3 w = glm::mix(1.0f - share, share, glm::vec3(step));
    sum += w.x * w.y * w.z * volume.at(glm::ivec3(low) + step);
  }
  return sum;
}

}  // namespace

void pull_to_hull(const SparseVolume& hull, std::span<const glm::vec3> positions,
                  std::span<const float> texture, const RimOptions& options,
                  std::vector<Peak>& peaks) {
  tbb::parallel_for(std::size_t(0), peaks.size(), [&](std::size_t i) {
    const float under = -distance_at(hull, positions[i]);
    const float share = 1 - std::clamp(under, 0.0f, float(options.reach)) / float(options.reach);
    Peak& peak = peaks[i];
    const float weight = float(options.weight) * share * (1 - texture[i]);
    if (!(weight > 0)) return;
    peak.offset = (peak.weight * peak.offset + weight * under) / (peak.weight + weight);
    peak.weight += weight;
  });
}

}  // namespace photohull::refine
