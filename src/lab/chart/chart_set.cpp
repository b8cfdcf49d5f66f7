#include "lab/chart/chart_set.h"

#include <algorithm>

#include "core/error.h"

namespace photohull::chart {
namespace {

void add_charts(const ChartInput& input, std::vector<Chart>& charts) {
  if (input.outcomes.empty()) return;
  charts.push_back(speed_chart(input, TimeKind::kCpu));
  const auto own = [&](auto&& wanted) {
    return std::any_of(input.outcomes.begin(), input.outcomes.end(), wanted);
  };
  if (own([](const Outcome& o) { return o.wall_seconds.has_value(); }))
    charts.push_back(speed_chart(input, TimeKind::kWall));
  if (own([](const Outcome& o) { return o.resolution.has_value(); })) {
    charts.push_back(accuracy_chart(input));
    charts.push_back(cost_chart(input));
  }
  if (own([](const Outcome& o) { return !o.stages.empty(); })) charts.push_back(stage_chart(input));
}

}  // namespace

std::vector<Chart> make_charts(const std::vector<Outcome>& outcomes,
                               const std::vector<std::string>& scenes,
                               const std::vector<std::string>& mean_over,
                               double threshold_percent) {
  ChartInput input;
  input.styles = styles_of(outcomes);
  input.threshold_percent = threshold_percent;
  std::vector<Chart> charts;
  const std::vector<std::string>& averaged = mean_over.empty() ? scenes : mean_over;
  if (averaged.size() > 1) {
    input.group = "mean";
    input.heading = concat("mean over ", averaged.size(), " scenes");
    input.outcomes = means_over(outcomes, averaged);
    add_charts(input, charts);
  }
  for (const std::string& scene : scenes) {
    input.group = input.heading = scene;
    input.outcomes.clear();
    std::copy_if(outcomes.begin(), outcomes.end(), std::back_inserter(input.outcomes),
                 [&](const Outcome& o) { return o.scene == scene; });
    add_charts(input, charts);
  }
  return charts;
}

}  // namespace photohull::chart
