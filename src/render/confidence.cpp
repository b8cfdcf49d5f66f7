#include "render/confidence.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace photohull::render {
namespace {

constexpr int kRounds = 5;               // of means over triangles
constexpr double kPriorPairs = 0.1;      // weight of the prior, in views beyond the first
constexpr double kPriorDeviation = 0.1;  // between views that say nothing
constexpr double kLeastFine = 1e-3;      // variance below which fine detail is none
constexpr double kLeastDeviation = 0.01, kLeastScatter = 0.05;  // bend the logarithms

// Fitted by `python3 -m bench fit_confidence` on half of the synthetic scenes
// (docs/guide/evaluate.md).
constexpr double kConstant = -6.55, kByDisagreement = -2.50, kByScatter = 0.61, kByShare = -1.74;
constexpr double kSilhouettesOnly = -1.67;
constexpr double kLeastConfidence = 1e-3;  // of what is seen

/// Sums over a vertex's surroundings.
struct Pool {
  float weight = 0, scatter = 0, spare = 0;  ///< spare: views beyond the first
  float disagreement = 0, fine_disagreement = 0, fine_energy = 0;

  void operator+=(const Pool& o) {
    weight += o.weight;
    scatter += o.scatter;
    spare += o.spare;
    disagreement += o.disagreement;
    fine_disagreement += o.fine_disagreement;
    fine_energy += o.fine_energy;
  }
};

Pool pool_of(const SurfaceEvidence& e) {
  if (!(e.views > 0)) return {};
  return {1,
          e.scatter,
          e.views - 1,
          e.views * e.disagreement,
          e.views * e.fine_disagreement,
          e.fine_energy};
}

/// Adds to every corner what its triangles hold.
void spread(const TriMesh& mesh, std::vector<Pool>& pools) {
  const std::vector<Pool> before = pools;
  for (const auto& [a, b, c] : mesh.triangles) {
    Pool sum = before[a];
    sum += before[b];
    sum += before[c];
    for (const std::uint32_t corner : {a, b, c}) pools[corner] += sum;
  }
}

PooledEvidence sum_up(const Pool& p, const SurfaceEvidence& own) {
  const double spare = double(p.spare) / p.weight + kPriorPairs;
  const double energy = double(p.fine_energy) / p.weight;
  const double variance =
      (double(p.disagreement) / p.weight + kPriorPairs * kPriorDeviation * kPriorDeviation) / spare;
  const double fine = (double(p.fine_disagreement) / p.weight + kPriorPairs * energy) / spare;
  return {true,
          p.scatter / p.weight,
          float(std::sqrt(variance)),
          float((fine + kLeastFine) / (energy + 2 * kLeastFine)),
          own.views,
          own.seeing};
}

}  // namespace

std::vector<PooledEvidence> pool_evidence(const TriMesh& mesh,
                                          std::span<const SurfaceEvidence> evidence) {
  PHOTOHULL_CHECK_OP(evidence.size(), ==, mesh.positions.size());
  std::vector<Pool> pools(evidence.size());
  std::transform(evidence.begin(), evidence.end(), pools.begin(), pool_of);
  for (int round = 0; round < kRounds; ++round) spread(mesh, pools);
  std::vector<PooledEvidence> pooled(evidence.size());
  for (std::size_t i = 0; i < evidence.size(); ++i)
    if (evidence[i].views > 0) pooled[i] = sum_up(pools[i], evidence[i]);
  return pooled;
}

double confidence_of(const PooledEvidence& e, Shaping shaping) {
  if (!e.seen) return 0;
  const double odds = kConstant + (shaping == Shaping::kSilhouettes ? kSilhouettesOnly : 0) +
                      kByDisagreement * std::log(e.disagreement + kLeastDeviation) +
                      kByScatter * std::log(e.scatter + kLeastScatter) +
                      kByShare * std::log(double(e.fine_share));
  return std::clamp(1 / (1 + std::exp(-odds)), kLeastConfidence, 1.0);
}

}  // namespace photohull::render
