#include <algorithm>
#include <array>
#include <cmath>

#include "lab/chart/chart_set.h"

namespace photohull::chart {
namespace {

// Paul Tol's muted scheme, which stays apart in all kinds of colour vision.
constexpr std::array kStageColours = {"#332288", "#88ccee", "#44aa99", "#117733",
                                      "#999933", "#ddcc77", "#cc6677", "#882255",
                                      "#aa4499", "#bbbbbb", "#661100", "#6699cc"};
constexpr double kLabelledShare = 7;  ///< percent

struct Bar {
  const Outcome* outcome;
  double total = 0;  ///< CPU seconds of its stages
};

std::string bar_label(const Bar& bar) {
  const std::string text = bar.outcome->label();
  if (bar.outcome->failed || bar.total <= 0) return text + " (failed)";
  return text + " (" + shown(bar.total) + " s)";
}

Json stage_series(const std::string& stage, const char* colour, const std::vector<Bar>& bars) {
  Json data = Json::array();
  for (const Bar& bar : bars) {
    double seconds = 0;
    for (const StageTime& s : bar.outcome->stages)
      if (s.name == stage) seconds += s.cpu_seconds;
    const double share = bar.total > 0 ? 100 * seconds / bar.total : 0;
    // Rounded, so that equal runs give equal files.
    Json d = {{"value", std::round(share * 1000) / 1000},
              {"tooltip",
               {{"formatter", "<b>" + escaped(bar.outcome->label()) + "</b><br>" + escaped(stage) +
                                  ": " + shown(seconds) + " CPU s, " + shown(share) + " %"}}}};
    if (share >= kLabelledShare)
      d["label"] = {{"show", true}, {"formatter", shown(std::round(share)) + " %"}};
    data.push_back(std::move(d));
  }
  const std::string c = colour;
  const bool dark = c == "#332288" || c == "#117733" || c == "#882255" || c == "#661100" ||
                    c == "#aa4499" || c == "#cc6677";
  return {{"type", "bar"},
          {"name", stage},
          {"stack", "stages"},
          {"barWidth", "70%"},
          {"itemStyle", {{"color", colour}, {"borderColor", "#fff"}, {"borderWidth", 1}}},
          {"label", {{"show", false}, {"color", dark ? "#fff" : "#111"}, {"fontSize", 11}}},
          {"data", data}};
}

}  // namespace

Chart stage_chart(const ChartInput& input) {
  std::vector<Bar> bars;
  std::vector<std::string> stages, names;
  std::size_t longest = 0;
  for (const Outcome& o : input.outcomes) {
    if (o.external) continue;
    Bar bar{&o};
    auto next = stages.begin();
    for (const StageTime& s : o.stages) {
      bar.total += s.cpu_seconds;
      // A stage that only some runs have goes where those have it.
      const auto known = std::find(stages.begin(), stages.end(), s.name);
      next = (known == stages.end() ? stages.insert(next, s.name) : known) + 1;
    }
    bars.push_back(bar);
    names.push_back(bar_label(bar));
    longest = std::max(longest, names.back().size());
  }
  const int room = legend_room(stages), height = 160 + room + 26 * int(bars.size());
  Chart chart{"stages--" + input.group, input.group, 1000, height, {}};
  const std::string what = input.outcomes.front().scenes > 1 ? " (CPU seconds summed)" : "";
  chart.option = base_option("Where CPU time goes: " + input.heading + what, stages);
  chart.option["grid"] = {
      {"left", 30 + 7 * int(longest)}, {"right", 40}, {"top", 92 + room}, {"bottom", 56}};
  chart.option["xAxis"] = {{"type", "value"},
                           {"min", 0},
                           {"max", 100},
                           {"name", "share of the run's CPU time (%)"},
                           {"nameLocation", "middle"},
                           {"nameGap", 28},
                           {"nameTextStyle", {{"fontSize", 13}, {"color", "#222"}}},
                           {"axisLabel", {{"color", "#222"}}},
                           {"splitLine", {{"lineStyle", {{"color", "#e4e4e4"}}}}}};
  chart.option["yAxis"] = {{"type", "category"},
                           {"inverse", true},
                           {"data", names},
                           {"axisTick", {{"show", false}}},
                           {"axisLabel", {{"color", "#222"}, {"interval", 0}}}};
  for (std::size_t i = 0; i < stages.size(); ++i)
    chart.option["series"].push_back(
        stage_series(stages[i], kStageColours[i % kStageColours.size()], bars));
  return chart;
}

}  // namespace photohull::chart
