#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <set>

#include "core/error.h"
#include "lab/chart/chart_set.h"
#include "lab/chart/statistics.h"

namespace photohull::chart {
namespace {

constexpr int kWidth = 1000, kHeight = 500;
constexpr int kBottom = 60;

using Value = std::function<std::optional<double>(const Outcome&)>;

/// One of the two halves of a chart.
struct Panel {
  std::string axis_name;
  Value value;
  bool log = true;       ///< logarithmic, with fitted power laws
  bool bad_low = false;  ///< failed runs are marked at the lower end
  std::string law;       ///< what follows the power law, for its text
  bool text_at_top = false;
};

/// "hull: error ~ N^-0.93", with a minus sign and figures that people read.
std::string law_text(const std::string& name, const std::string& what, const PowerLaw& law) {
  char exponent[32];
  std::snprintf(exponent, sizeof exponent, "%.2f", std::abs(law.exponent));
  return name + ": " + what + " ∝ N^" + (law.exponent < 0 ? "−" : "") + exponent +
         (law.samples == 2 ? " (2 points)" : "");
}

class TwoPanels {
 public:
  TwoPanels(const ChartInput& input, Chart chart, const std::string& title)
      : in_(input), chart_(std::move(chart)) {
    std::vector<std::string> legend;
    std::set<double> resolutions;
    for (const SeriesStyle& s : in_.styles)
      if (!rows(s).empty()) legend.push_back(s.name);
    for (const Outcome& o : in_.outcomes) {
      if (o.resolution) resolutions.insert(*o.resolution);
      any_failed_ = any_failed_ || (o.resolution && (o.failed || o.failed_scenes));
    }
    if (any_failed_) legend.push_back("failed");
    ticks_.assign(resolutions.begin(), resolutions.end());
    top_ += legend_room(legend);
    chart_.height += legend_room(legend);
    chart_.option = base_option(title + ": " + in_.heading, legend);
    for (const char* part : {"grid", "xAxis", "yAxis", "graphic"})
      chart_.option[part] = Json::array();
  }

  void add(const Panel& panel) {
    const int left = panels_ == 0 ? 80 : 584, width = 382;
    chart_.option["grid"].push_back(
        {{"left", left}, {"width", width}, {"top", top_}, {"bottom", kBottom}});
    add_axes(panel);
    Json crosses = Json::array();
    int line = 0;
    for (const SeriesStyle& s : in_.styles) add_variant(panel, s, left, line, crosses);
    if (any_failed_) {
      Json failed = failed_series(crosses);
      on_panel(failed);
      chart_.option["series"].push_back(failed);
    }
    ++panels_;
  }

  Chart take() { return std::move(chart_); }

 private:
  /// Outcomes of a variant that have a resolution, by rising resolution.
  std::vector<const Outcome*> rows(const SeriesStyle& s) const {
    std::vector<const Outcome*> found;
    for (const Outcome& o : in_.outcomes)
      if (o.resolution && o.variant == s.name && o.external == s.external) found.push_back(&o);
    std::stable_sort(found.begin(), found.end(),
                     [](auto* a, auto* b) { return *a->resolution < *b->resolution; });
    return found;
  }

  void add_axes(const Panel& panel) {
    const auto [low, high] = log_range(ticks_);
    Json x = log_axis("resolution N (voxels along the box's longest side)", low, high, ticks_);
    x["gridIndex"] = panels_;
    std::vector<double> values;
    for (const Outcome& o : in_.outcomes)
      if (o.resolution && o.complete())
        if (const auto v = panel.value(o)) values.push_back(*v);
    Json y;
    if (panel.log) {
      std::tie(low_, high_) = log_range(values);
      if (high_ / low_ < 4) {
        low_ /= 1.5;
        high_ *= 1.5;
      }
      y = log_axis(panel.axis_name, low_, high_, log_ticks(low_, high_));
    } else {
      const double least = values.empty() ? 0 : *std::min_element(values.begin(), values.end());
      low_ = any_failed_ ? 0 : std::max(0.0, 10 * std::floor(least / 10 - 0.3));
      high_ = 100;
      y = log_axis(panel.axis_name, low_, high_, {});
      y["type"] = "value";
      y.erase("axisTick");
      y["axisLabel"] = {{"color", "#222"}};
    }
    y["nameGap"] = 52;
    y["splitLine"] = {{"show", true}, {"lineStyle", {{"color", "#e4e4e4"}}}};
    y["gridIndex"] = panels_;
    chart_.option["xAxis"].push_back(x);
    chart_.option["yAxis"].push_back(y);
  }

  void on_panel(Json& series) const {
    series["xAxisIndex"] = panels_;
    series["yAxisIndex"] = panels_;
  }

  void add_variant(const Panel& panel, const SeriesStyle& s, int left, int& line, Json& crosses) {
    Json data = Json::array();
    std::vector<Sample> samples;
    for (const Outcome* o : rows(s)) {
      const Json hover = {{"formatter", hover_text(*o)}};
      const auto value = panel.value(*o);
      if (o->failed || o->failed_scenes) {
        crosses.push_back(
            {{"name", o->label() + " failed"},
             {"value", {*o->resolution, panel.bad_low ? low_ : high_}},
             {"itemStyle", {{"color", "none"}, {"borderColor", s.colour}, {"borderWidth", 2}}},
             {"tooltip", hover}});
      } else if (o->complete() && value && (!panel.log || *value > 0)) {
        data.push_back(
            {{"name", o->label()}, {"value", {*o->resolution, *value}}, {"tooltip", hover}});
        samples.push_back({double(*o->resolution), *value});
      }
    }
    if (data.empty()) return;
    Json series = {{"type", "line"},
                   {"name", s.name},
                   {"symbol", s.symbol},
                   {"symbolSize", kMarker - 1},
                   {"showAllSymbol", true},
                   {"z", 4},
                   {"itemStyle", item_style(s)},
                   {"lineStyle", {{"color", s.colour}, {"width", panel.log ? 0 : 1.6}}},
                   {"data", data}};
    on_panel(series);
    chart_.option["series"].push_back(series);
    if (panel.log) add_law(panel, s, samples, left, line);
  }

  void add_law(const Panel& panel, const SeriesStyle& s, const std::vector<Sample>& samples,
               int left, int& line) {
    const auto law = fit_power_law(samples);
    if (!law) return;
    Json fit = {{"type", "line"},
                {"name", s.name},
                {"symbol", "none"},
                {"silent", true},
                {"z", 3},
                {"lineStyle", {{"color", s.colour}, {"width", 1.4}, {"type", "dashed"}}},
                {"itemStyle", {{"color", s.colour}}},
                {"data",
                 {{samples.front().x, law->at(samples.front().x)},
                  {samples.back().x, law->at(samples.back().x)}}}};
    on_panel(fit);
    chart_.option["series"].push_back(fit);
    chart_.option["graphic"].push_back(
        {{"type", "text"},
         {"silent", true},
         {"z", 6},
         {"left", left + 10},
         {panel.text_at_top ? "top" : "bottom",
          panel.text_at_top ? top_ + 6 + 16 * line : kBottom + 8 + 16 * line},
         {"style",
          {{"text", law_text(s.name, panel.law, *law)},
           {"fill", s.colour},
           {"fontSize", 12},
           {"fontFamily", "sans-serif"}}}});
    ++line;
  }

  const ChartInput& in_;
  Chart chart_;
  std::vector<double> ticks_;
  int panels_ = 0;
  int top_ = 96;  ///< of the plots, pixels
  bool any_failed_ = false;
  double low_ = 1, high_ = 10;
};

}  // namespace

Chart accuracy_chart(const ChartInput& input) {
  TwoPanels panels(input, {"accuracy-resolution--" + input.group, input.group, kWidth, kHeight, {}},
                   "Accuracy against resolution");
  panels.add({"error: 90 % of the mesh within (% of the diagonal)",
              [](const Outcome& o) { return o.figures.accuracy_percent; }, true, false, "error",
              false});
  panels.add({"F-score at " + shown(input.threshold_percent) + " % of the diagonal (%)",
              [t = input.threshold_percent](const Outcome& o) { return o.figures.f_at(t); }, false,
              true, "", false});
  return panels.take();
}

Chart cost_chart(const ChartInput& input) {
  TwoPanels panels(input, {"cost-resolution--" + input.group, input.group, kWidth, kHeight, {}},
                   "Time and memory against resolution");
  panels.add({"CPU time (s, user + system)", [](const Outcome& o) { return o.cpu_seconds; }, true,
              false, "time", true});
  panels.add({"peak memory (MiB)", [](const Outcome& o) { return o.peak_mb; }, true, false,
              "memory", true});
  return panels.take();
}

}  // namespace photohull::chart
