// The charts and their figures as one HTML page.
#pragma once

#include <string>
#include <vector>

#include "chart/chart_set.h"

namespace photohull::chart {

/// A page that needs nothing else: ECharts, the charts with values to point at, and a table of all
/// outcomes with failed ones marked. It loads nothing from anywhere.
std::string make_page(const std::string& title, const std::vector<std::string>& notes,
                      const std::vector<Chart>& charts, const std::vector<Outcome>& outcomes,
                      double threshold_percent);

}  // namespace photohull::chart
