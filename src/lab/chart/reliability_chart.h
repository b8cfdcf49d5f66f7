// Reliability diagrams: what confidence promises against what is true [NiculescuMizilCaruana05].
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "lab/chart/chart_set.h"

namespace photohull::chart {

/// One bin of confidence; shares in [0, 1].
struct ReliabilityPoint {
  double low = 0, high = 0;
  std::size_t count = 0;
  double confidence = 0;  ///< mean
  double within = 0;      ///< share that is right
};

struct ReliabilityCurve {
  std::string name;
  std::vector<ReliabilityPoint> bins;  ///< the same ones for all curves of a chart
};

/// Share against mean confidence of every bin that holds something, with the diagonal of perfect
/// calibration, and under it the bins' shares of all that counts.
Chart reliability_chart(const std::string& title, const std::vector<ReliabilityCurve>& curves);

}  // namespace photohull::chart
