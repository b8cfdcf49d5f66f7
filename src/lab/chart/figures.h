// How close a mesh came to the truth.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "lab/chart/json_fields.h"

namespace photohull::chart {

/// Distances and thresholds are percent of the diagonal of the truth's bounding box.
struct Figures {
  std::map<double, double> f_percent;          ///< F-score, 0 to 100, at each threshold
  std::optional<double> accuracy_percent;      ///< distance that 90 % of the mesh is within
  std::optional<double> completeness_percent;  ///< share of the truth that is within 0.5 %
  std::optional<std::int64_t> triangles;

  /// F-score at a threshold, which may differ in the last digits.
  std::optional<double> f_at(double threshold_percent) const;
};

/// What `photohull evaluate --json` printed (docs/guide/evaluate.md), over the surface that cameras
/// see; throws Error when it has no F-score.
Figures figures_of_evaluation(const Json& evaluation);

}  // namespace photohull::chart
