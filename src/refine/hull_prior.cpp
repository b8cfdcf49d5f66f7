// Rims of silhouettes as a constraint on the surface [Furukawa09].
#include "refine/hull_prior.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace photohull::refine {

namespace {

constexpr int kRounds = 10;  // of averaging with the neighbours: three or four voxels around
constexpr float kFullWeight = 1,
                kEvidenceAround = 0.7f;  // weights of peaks that the hull is measured by
constexpr double kReach = 1;             // voxels under the hull: it has lost its say there
constexpr double kPriorCount = 100;      // of peaks to begin with, where none are known
constexpr double kPower = 4;             // of the share of them, that the hull is believed by

/// Weights of the peaks, none counted for more than 1, averaged over the surface around.
std::vector<float> evidence_around(const VertexGraph& graph, const std::vector<Peak>& peaks) {
  std::vector<float> mean(peaks.size()), next(peaks.size());
  for (std::size_t i = 0; i < peaks.size(); ++i) mean[i] = std::min(peaks[i].weight, 1.0f);
  for (int round = 0; round < kRounds; ++round) {
    tbb::parallel_for(std::size_t(0), peaks.size(), [&](std::size_t i) {
      float sum = mean[i];
      for (const std::uint32_t j : graph.of(i)) sum += mean[j];
      next[i] = sum / float(1 + graph.of(i).size());
    });
    mean.swap(next);
  }
  return mean;
}

/// Shares that are taken to lie on the hull before anything is told: what larger voxels told, or
/// all.
HullTrust shares_before(const std::optional<HullTrust>& coarser) {
  HullTrust shares;
  shares.fill(1);
  if (coarser)
    for (std::size_t i = 0; i < shares.size(); ++i)
      shares[i] = std::pow((*coarser)[std::min(i + 1, shares.size() - 1)], 1 / kPower);
  return shares;
}

/// How far the hull may be believed where nothing checks it: by the share of what photographs tell
/// surely that lies on it, to within a voxel.
HullTrust tightness(const SparseVolume& hull, std::span<const glm::vec3> positions,
                    const std::vector<Peak>& peaks, const std::vector<float>& evidence,
                    const std::optional<HullTrust>& coarser) {
  double sure = kPriorCount;
  HullTrust on_hull = shares_before(coarser);
  for (double& on : on_hull) on *= kPriorCount;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    if (!(peaks[i].weight >= kFullWeight && evidence[i] >= kEvidenceAround)) continue;
    sure += 1;
    const double under = -hull.interpolated(glm::dvec3(positions[i])) - peaks[i].offset;
    double reach = kReach;
    for (double& on : on_hull) on += under < reach, reach /= 2;
  }
  for (double& on : on_hull) on = std::pow(on / sure, kPower);
  return on_hull;
}

}  // namespace

HullTrust pull_to_hull(const SparseVolume& hull, const VertexGraph& graph,
                       std::span<const glm::vec3> positions, const PatchQuality& patches,
                       const HullPriorOptions& options, std::vector<Peak>& peaks) {
  const std::vector<float> evidence = evidence_around(graph, peaks);
  const HullTrust tight = tightness(hull, positions, peaks, evidence, options.coarser);
  const double strongest = options.weight * options.trust.value_or(tight.front());
  tbb::parallel_for(std::size_t(0), peaks.size(), [&](std::size_t i) {
    const float under = float(-hull.interpolated(glm::dvec3(positions[i])));
    const float share = 1 - std::clamp(under, 0.0f, float(kReach)) / float(kReach);
    Peak& peak = peaks[i];
    const float open = std::max(0.0f, 1 - evidence[i] / float(options.evidence));
    const float thick = patches.trust[i] * patches.trust[i];
    const float weight = float(strongest) * thick * share * open * (1 - patches.texture[i]);
    if (!(weight > 0)) return;
    peak.offset = (peak.weight * peak.offset + weight * under) / (peak.weight + weight);
    peak.weight += weight;
  });
  return tight;
}

}  // namespace photohull::refine
