#include "lab/chart/sampling_chart.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace photohull::chart {
namespace {

constexpr int kWidth = 1240, kHeight = 560;
constexpr int kLeft = 84, kRight = 30, kTop = 118, kGap = 34, kBottom = 64;

/// Four decimals, so that equal runs give equal files.
double rounded(double value) { return std::round(value * 1e4) / 1e4; }

std::vector<SeriesStyle> styles_for(const std::vector<SamplingPanel>& panels) {
  std::vector<Outcome> names;
  for (const SamplingPanel& panel : panels)
    for (const SamplingCurve& curve : panel.curves)
      if (curve.like.empty()) names.emplace_back().variant = curve.name;
  return styles_of(names);
}

Json axis(const std::string& name, std::pair<double, double> range, int panel, double base) {
  return {{"type", "log"},
          {"logBase", base},
          {"gridIndex", panel},
          {"name", name},
          {"nameLocation", "middle"},
          {"nameGap", base == 2 ? 32 : 52},
          {"nameTextStyle", {{"fontSize", 13}, {"color", "#222"}}},
          {"min", range.first},
          {"max", range.second},
          {"axisLine", {{"show", true}, {"onZero", false}, {"lineStyle", {{"color", "#444"}}}}},
          {"axisTick", {{"show", true}}},
          {"axisLabel", {{"color", "#222"}}},
          {"splitLine", {{"lineStyle", {{"color", "#eee"}}}}}};
}

Json line_of(const SamplingCurve& curve, int panel, const SeriesStyle& style, Json data) {
  const bool dashed = !curve.like.empty();
  return {{"type", "line"},
          {"name", curve.name},
          {"xAxisIndex", panel},
          {"yAxisIndex", panel},
          {"symbol", style.symbol},
          {"symbolSize", 7},
          {"itemStyle", item_style({curve.name, style.colour, style.symbol, dashed})},
          {"lineStyle",
           {{"color", style.colour}, {"width", 1.6}, {"type", dashed ? "dashed" : "solid"}}},
          {"data", std::move(data)}};
}

}  // namespace

Chart sampling_chart(const std::string& title, const std::vector<SamplingPanel>& panels,
                     const PanelAxes& axes) {
  PHOTOHULL_CHECK(!panels.empty());
  const std::vector<SeriesStyle> styles = styles_for(panels);
  std::vector<std::string> legend;
  for (const SamplingCurve& curve : panels[0].curves) legend.push_back(curve.name);
  legend.push_back(axes.mark_name);
  std::pair<double, double> x{1e30, 0}, y{1e30, 0};
  for (const SamplingPanel& panel : panels)
    for (const SamplingCurve& curve : panel.curves)
      for (const auto& [footprint, error] : curve.points) {
        x = {std::min(x.first, footprint), std::max(x.second, footprint)};
        y = {std::min(y.first, error), std::max(y.second, error)};
      }
  y = {std::pow(10.0, std::floor(std::log10(y.first))),
       std::pow(10.0, std::ceil(std::log10(y.second)))};

  Chart chart{"sampling", "sampling", kWidth, kHeight, {}};
  chart.option = base_option(title, legend);
  chart.option["legend"]["width"] = kWidth - 60;
  const int width =
      (kWidth - kLeft - kRight - kGap * (int(panels.size()) - 1)) / int(panels.size());
  chart.option["grid"] = Json::array();
  chart.option["xAxis"] = Json::array();
  chart.option["yAxis"] = Json::array();
  for (int i = 0; i < int(panels.size()); ++i) {
    const SamplingPanel& panel = panels[std::size_t(i)];
    chart.option["grid"].push_back({{"left", kLeft + i * (width + kGap)},
                                    {"width", width},
                                    {"top", kTop},
                                    {"bottom", kBottom}});
    chart.option["xAxis"].push_back(axis(axes.x + ", " + panel.name, x, i, 2));
    chart.option["yAxis"].push_back(axis(i == 0 ? axes.y : "", y, i, 10));
    if (i > 0) chart.option["yAxis"].back()["axisLabel"]["show"] = false;
    chart.option["series"].push_back(
        {{"type", "line"},
         {"name", axes.mark_name},
         {"xAxisIndex", i},
         {"yAxisIndex", i},
         {"symbol", "none"},
         {"itemStyle", {{"color", "#777"}}},
         {"lineStyle", {{"color", "#777"}, {"width", 1.4}, {"type", "dashed"}}},
         {"data", {{x.first, axes.mark}, {x.second, axes.mark}}}});
    for (const SamplingCurve& curve : panel.curves) {
      Json data = Json::array();
      for (const auto& [footprint, error] : curve.points)
        data.push_back({footprint, rounded(error)});
      const std::string& look = curve.like.empty() ? curve.name : curve.like;
      const auto style = std::find_if(styles.begin(), styles.end(),
                                      [&](const SeriesStyle& s) { return s.name == look; });
      PHOTOHULL_CHECK(style != styles.end());
      chart.option["series"].push_back(line_of(curve, i, *style, std::move(data)));
    }
  }
  return chart;
}

}  // namespace photohull::chart
