#include "lab/chart/reliability_chart.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace photohull::chart {
namespace {

constexpr int kWidth = 640, kHeight = 720;
constexpr int kLeft = 84, kRight = 36, kTop = 76, kPlot = 430, kGap = 44, kHistogram = 90;
constexpr const char* kPerfect = "perfect calibration";

/// Four decimals, so that equal runs give equal files.
double rounded(double value) { return std::round(value * 1e4) / 1e4; }

Json axis(const std::string& name, double high, double step, int panel) {
  return {{"type", "value"},
          {"gridIndex", panel},
          {"name", name},
          {"nameLocation", "middle"},
          {"nameGap", 44},
          {"nameTextStyle", {{"fontSize", 13}, {"color", "#222"}}},
          {"min", 0},
          {"max", high},
          {"interval", step},
          {"axisLine", {{"show", true}, {"lineStyle", {{"color", "#444"}}}}},
          {"axisTick", {{"show", true}}},
          {"axisLabel", {{"color", "#222"}}},
          {"splitLine", {{"lineStyle", {{"color", "#eee"}}}}}};
}

double total_of(const ReliabilityCurve& curve) {
  double sum = 0;
  for (const ReliabilityPoint& p : curve.bins) sum += double(p.count);
  return std::max(sum, 1.0);
}

Json curve_series(const ReliabilityCurve& curve, const SeriesStyle& style) {
  Json data = Json::array();
  for (const ReliabilityPoint& p : curve.bins)
    if (p.count > 0) data.push_back({rounded(p.confidence), rounded(p.within)});
  return {{"type", "line"},
          {"name", curve.name},
          {"symbol", style.symbol},
          {"symbolSize", kMarker},
          {"z", 4},
          {"itemStyle", item_style(style)},
          {"lineStyle", {{"color", style.colour}, {"width", 1.6}}},
          {"data", data}};
}

Json histogram_series(const ReliabilityCurve& curve, const SeriesStyle& style) {
  Json data = Json::array();
  for (const ReliabilityPoint& p : curve.bins)
    data.push_back(
        {rounded(0.5 * (p.low + p.high)), rounded(100 * double(p.count) / total_of(curve))});
  return {{"type", "bar"},   {"name", curve.name}, {"xAxisIndex", 1},
          {"yAxisIndex", 1}, {"barMaxWidth", 24},  {"itemStyle", item_style(style)},
          {"data", data}};
}

Json diagonal() {
  return {{"type", "line"},
          {"name", kPerfect},
          {"symbol", "none"},
          {"z", 2},
          {"itemStyle", {{"color", "#777"}}},
          {"lineStyle", {{"color", "#777"}, {"width", 1.4}, {"type", "dashed"}}},
          {"data", {{0, 0}, {1, 1}}}};
}

/// Styles as variants of a page have them.
std::vector<SeriesStyle> styles_for(const std::vector<ReliabilityCurve>& curves) {
  std::vector<Outcome> names(curves.size());
  for (std::size_t i = 0; i < curves.size(); ++i) names[i].variant = curves[i].name;
  std::vector<SeriesStyle> styles = styles_of(names);
  PHOTOHULL_CHECK_OP(styles.size(), ==, curves.size());
  return styles;
}

}  // namespace

Chart reliability_chart(const std::string& title, const std::vector<ReliabilityCurve>& curves) {
  const std::vector<SeriesStyle> styles = styles_for(curves);
  std::vector<std::string> legend;
  double most = 0;  // percent
  for (const ReliabilityCurve& curve : curves) {
    legend.push_back(curve.name);
    for (const ReliabilityPoint& p : curve.bins)
      most = std::max(most, 100 * double(p.count) / total_of(curve));
  }
  legend.emplace_back(kPerfect);
  Chart chart{"reliability", "reliability", kWidth, kHeight, {}};
  chart.option = base_option(title, legend);
  chart.option["title"][0]["textStyle"]["fontSize"] = 15;
  chart.option["legend"]["width"] = kWidth - 40;
  const int below = kTop + kPlot + kGap;
  chart.option["grid"] =
      Json::array({{{"left", kLeft}, {"right", kRight}, {"top", kTop}, {"height", kPlot}},
                   {{"left", kLeft}, {"right", kRight}, {"top", below}, {"height", kHistogram}}});
  Json unnamed = axis("", 1, 0.1, 0);
  Json named = axis("confidence", 1, 0.1, 1);
  named["nameGap"] = 30;
  chart.option["xAxis"] = Json::array({unnamed, named});
  const double top = most > 50 ? 100 : 50;
  chart.option["yAxis"] = Json::array({axis("share of the vertices that are right", 1, 0.1, 0),
                                       axis("vertices (%)", top, top / 2, 1)});
  chart.option["series"].push_back(diagonal());
  for (std::size_t i = 0; i < curves.size(); ++i) {
    chart.option["series"].push_back(curve_series(curves[i], styles[i]));
    chart.option["series"].push_back(histogram_series(curves[i], styles[i]));
  }
  return chart;
}

}  // namespace photohull::chart
