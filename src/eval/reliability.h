// Does a mesh's confidence mean what it says? Definitions in docs/guide/evaluate.md.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/mesh.h"
#include "core/progress.h"
#include "eval/truth.h"

namespace photohull::eval {

/// Vertices whose confidence is above `low` and at most `high`.
struct ReliabilityBin {
  double low = 0, high = 0;
  std::size_t count = 0;
  double confidence = 0;  ///< mean; 0 where there are no vertices
  double within = 0;      ///< share of them within the distance; 0 where there are no vertices
};

/// Confidence c of vertices that some camera saw (c > 0) against whether they lie within a distance
/// of the truth. Shares are of vertices, in [0, 1].
struct Reliability {
  double distance = 0;     ///< world units
  std::size_t unseen = 0;  ///< vertices of confidence 0, which say nothing and count nowhere below
  std::size_t seen = 0;    ///< the others
  double confidence = 0;   ///< their mean
  double within = 0;       ///< share within the distance
  std::vector<ReliabilityBin> bins;  ///< kReliabilityBins of equal width, rising
  double calibration_error = 0;      ///< sum over the bins of count / seen * |confidence - within|
                                     ///< [Naeini15]
  double brier = 0;                  ///< mean of (c - [within])^2 [Brier50]
  /// Chance that of two vertices, one within the distance and one not, the former has the greater
  /// c; equal ones count half. None when all or no vertices lie within.
  std::optional<double> auc;
  /// Rank correlation of c and the distance from the truth; -1 is best. None when either is the
  /// same everywhere.
  std::optional<double> spearman;
};

inline constexpr int kReliabilityBins = 10;

/// Measures all of that for vertices within `distance` (world units, > 0) of the truth's surface.
/// Throws Error when the mesh has no confidence, one that is no number from 0 to 1, or none above
/// 0; UsageError for a bad distance; Cancelled.
Reliability measure_reliability(const TriMesh& result, const Truth& truth, double distance,
                                Progress& progress);

/// The same from the distances themselves: one confidence in [0, 1] and one distance a vertex.
Reliability reliability_of(const std::vector<float>& confidence,
                           const std::vector<double>& distances, double distance);

}  // namespace photohull::eval
