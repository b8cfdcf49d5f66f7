// Breakdown curves as option objects of ECharts.
#pragma once

#include <vector>

#include "lab/chart/chart_set.h"
#include "lab/chart/stress_summary.h"

namespace photohull::chart {

/// "marks" (what every promise keeps), where there are any, then a chart for every group of axes: a
/// panel an axis with F-scores and confidence against strength, a colour a variant.
std::vector<Chart> stress_charts(const StressPlan& plan, const StressSummary& summary);

}  // namespace photohull::chart
