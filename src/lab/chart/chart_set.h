// The charts of a set of results, as option objects of ECharts. One definition serves the page and
// the static files.
#pragma once

#include <string>
#include <vector>

#include "lab/chart/outcome.h"
#include "lab/chart/style.h"

namespace photohull::chart {

struct Chart {
  std::string id;     ///< file name without extension: "speed-accuracy--bunny"
  std::string group;  ///< scene's name, or "mean"
  int width = 1000, height = 640;
  Json option;
};

/// What a chart is drawn from: the outcomes of one scene, or the means over several.
struct ChartInput {
  std::string group;    ///< "bunny", "mean"
  std::string heading;  ///< end of titles: "bunny", "mean over 6 scenes"
  std::vector<Outcome> outcomes;
  std::vector<SeriesStyle> styles;
  double threshold_percent = 0.25;
};

/// Seconds (logarithmic) against the F-score, stretched towards 100 %, with the Pareto front,
/// lines of equal quality and labelled points.
Chart speed_chart(const ChartInput& input, TimeKind kind);
/// Error (log-log, with fitted slopes) and F-score against resolution.
Chart accuracy_chart(const ChartInput& input);
/// CPU seconds and memory against resolution (log-log, with fitted exponents).
Chart cost_chart(const ChartInput& input);
/// Shares of CPU time of the stages, a bar a run.
Chart stage_chart(const ChartInput& input);

/// All charts that have something to show: of the mean, if there are several scenes, then of each
/// scene. `mean_over` names the scenes of the mean; empty: all.
std::vector<Chart> make_charts(const std::vector<Outcome>& outcomes,
                               const std::vector<std::string>& scenes,
                               const std::vector<std::string>& mean_over, double threshold_percent);

}  // namespace photohull::chart
