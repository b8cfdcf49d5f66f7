// Figures that sum up many distances.
#pragma once

#include <vector>

namespace photohull::eval {

/// In the unit of the distances; all zero when there are none.
struct DistanceStats {
  double mean = 0, median = 0, rms = 0, q95 = 0, max = 0;
};

DistanceStats distance_stats(const std::vector<double>& distances);

/// The least value that at least a share `q` of the values does not exceed (numpy's
/// `inverted_cdf`). `values` must not be empty; q in [0, 1].
double quantile(std::vector<double> values, double q);

/// Share of the values that do not exceed `limit`; 0 when there are none.
double share_within(const std::vector<double>& values, double limit);

}  // namespace photohull::eval
