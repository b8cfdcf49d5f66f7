#include "lab/chart/stress_charts.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "lab/chart/style.h"

namespace photohull::chart {
namespace {

constexpr int kWidth = 1000, kTop = 92, kPanelHeight = 190, kPanelRow = 296, kPanelWidth = 400;
constexpr int kLeft[2] = {62, 566};
constexpr const char* kPromised = "confidence";
constexpr const char* kTrue = "within a voxel";
constexpr const char* kPromisedColour = "#8c564b";
constexpr const char* kTrueColour = "#8a8a8a";

double percent(double share) { return std::round(1e4 * share) / 100; }

std::string fine(const std::string& variant) { return "F 0.25 %, " + variant; }
std::string coarse(const std::string& variant) { return "F 0.5 %, " + variant; }

/// Places on the axis: strengths, or 0, 1, 2 ... of kinds and of strengths without a logarithm.
class Panel {
 public:
  Panel(const StressAxis& axis, std::vector<const StressCurve*> curves,
        const std::vector<SeriesStyle>& styles, int index)
      : axis_(axis), curves_(std::move(curves)), styles_(styles), index_(index) {
    for (const CurvePoint& p : curves_.front()->points) {
      labels_.push_back(p.label);
      log_ = log_ || p.strength > 0;
    }
    log_ = axis.log && !axis.kinds;
    for (const CurvePoint& p : curves_.front()->points) log_ = log_ && p.strength > 0;
    categories_ = axis.kinds || (axis.log && !log_);
  }

  void add_to(Json& option, int top) const {
    const int left = kLeft[index_ % 2];
    option["grid"].push_back(
        {{"left", left}, {"width", kPanelWidth}, {"top", top}, {"height", kPanelHeight}});
    option["xAxis"].push_back(x_axis());
    option["yAxis"].push_back({{"type", "value"},
                               {"gridIndex", index_},
                               {"min", 0},
                               {"max", 100},
                               {"interval", 20},
                               {"name", index_ % 2 ? "" : "%"},
                               {"axisLabel", {{"color", "#222"}}},
                               {"splitLine", {{"lineStyle", {{"color", "#eee"}}}}}});
    option["title"].push_back({{"text", axis_.title},
                               {"left", left + kPanelWidth / 2},
                               {"top", top - 40},
                               {"textAlign", "center"},
                               {"textStyle", {{"fontSize", 13}, {"color", "#111"}}}});
    for (std::size_t c = curves_.size(); c-- > 0;) add_curve(*curves_[c], c == 0, option["series"]);
  }

 private:
  Json x_axis() const {
    std::string name = axis_.unit;
    Json axis = {
        {"type", categories_ ? "category"
                 : log_      ? "log"
                             : "value"},
        {"gridIndex", index_},
        {"name", name},
        {"nameLocation", "middle"},
        {"nameGap", axis_.kinds ? 44 : 26},
        {"nameTextStyle", {{"fontSize", 12}, {"color", "#222"}}},
        {"axisLine", {{"show", true}, {"onZero", false}, {"lineStyle", {{"color", "#444"}}}}},
        {"splitLine", {{"show", false}}}};
    if (categories_) {
      axis["data"] = labels_;
      axis["axisLabel"] = {{"color", "#222"}, {"fontSize", 11}, {"interval", 0}};
      if (axis_.kinds) axis["axisLabel"]["width"] = kPanelWidth / int(labels_.size()) - 4;
      if (axis_.kinds) axis["axisLabel"]["overflow"] = "break";
      if (axis_.kinds) axis["axisLabel"]["lineHeight"] = 14;
      return axis;
    }
    std::vector<double> at;
    for (const CurvePoint& p : curves_.front()->points) at.push_back(p.strength);
    const auto [low, high] = std::minmax_element(at.begin(), at.end());
    axis["min"] = *low, axis["max"] = *high;
    // From clean to the right.
    if (at.back() < at.front()) axis["inverse"] = true;
    axis["axisLabel"] = {{"customValues", at}, {"color", "#222"}, {"hideOverlap", true}};
    axis["axisTick"] = {{"customValues", at}, {"show", true}};
    return axis;
  }

  Json place(std::size_t point, double strength) const {
    return categories_ ? Json(point) : Json(strength);
  }

  template <typename Value>
  Json data_of(const StressCurve& curve, const Value& value) const {
    Json data = Json::array();
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      const CurvePoint& p = curve.points[i];
      const std::optional<double> y = value(p);
      if (!y) continue;
      data.push_back({{"value", {place(i, p.strength), percent(*y)}},
                      {"tooltip", {{"formatter", hover(curve, p)}}}});
    }
    return data;
  }

  std::string hover(const StressCurve& curve, const CurvePoint& p) const {
    const auto line = [](const char* name, const std::optional<double>& share) {
      return share ? std::string("<br>") + name + ": " + shown(percent(*share)) + " %"
                   : std::string();
    };
    std::string html = "<b>" + escaped(axis_.title) + " " + escaped(p.label) + "</b><br>" +
                       escaped(curve.variant) + concat("<br>mean over ", p.samples, " runs");
    html += line("F at 0.25 %", p.f025) + line("F at 0.5 %", p.f05) +
            line("of the clean F at 0.25 %", p.kept025) +
            line(("least, " + escaped(p.worst_scene)).c_str(), p.worst025) +
            line("mean confidence", p.confidence) + line("within a voxel", p.within);
    if (p.failed) html += concat("<br><b>", p.failed, " failed</b>");
    return html;
  }

  Json series(const std::string& name, const std::string& colour, const std::string& symbol,
              double width, const char* type, Json data) const {
    return {{"type", "line"},
            {"name", name},
            {"xAxisIndex", index_},
            {"yAxisIndex", index_},
            {"symbol", symbol},
            {"symbolSize", 7},
            {"showAllSymbol", true},
            {"clip", false},
            {"itemStyle", {{"color", colour}}},
            {"lineStyle", {{"color", colour}, {"width", axis_.kinds ? 0 : width}, {"type", type}}},
            {"data", std::move(data)}};
  }

  void add_curve(const StressCurve& curve, bool first, Json& all) const {
    const auto at = std::find_if(styles_.begin(), styles_.end(),
                                 [&](const SeriesStyle& s) { return s.name == curve.variant; });
    PHOTOHULL_CHECK(at != styles_.end());
    if (first) {
      add_scenes(curve, at->colour, all);
      all.push_back(series(kTrue, kTrueColour, "none", 1.4, "dotted",
                           data_of(curve, [](const CurvePoint& p) { return p.within; })));
      all.push_back(series(kPromised, kPromisedColour, "emptyTriangle", 1.4, "solid",
                           data_of(curve, [](const CurvePoint& p) { return p.confidence; })));
    }
    all.push_back(series(coarse(curve.variant), at->colour, "emptyRect", 1.4, "dashed",
                         data_of(curve, [](const CurvePoint& p) { return p.f05; })));
    Json main = series(fine(curve.variant), at->colour, "circle", 2.2, "solid",
                       data_of(curve, [](const CurvePoint& p) { return p.f025; }));
    main["z"] = first ? 5 : 4;
    if (first && curve.break025 && !categories_)
      main["markLine"] = {
          {"silent", true},
          {"symbol", "none"},
          {"lineStyle", {{"color", kFailedColour}, {"type", "dashed"}, {"width", 1}}},
          {"label",
           {{"formatter", shown(*curve.break025)}, {"color", kFailedColour}, {"fontSize", 11}}},
          {"data", Json::array({{{"xAxis", *curve.break025}}})}};
    all.push_back(main);
    Json crosses = data_of(curve, [](const CurvePoint& p) -> std::optional<double> {
      return p.failed ? p.f025 : std::nullopt;
    });
    if (crosses.empty()) return;
    Json failed = failed_series(crosses);
    failed["xAxisIndex"] = failed["yAxisIndex"] = index_;
    failed["z"] = 6;
    all.push_back(failed);
  }

  /// The scenes by themselves, thin and pale.
  void add_scenes(const StressCurve& curve, const std::string& colour, Json& all) const {
    if (curve.scenes.size() < 2) return;
    for (const auto& [scene, values] : curve.scenes) {
      Json data = Json::array();
      for (std::size_t i = 0; i < values.size(); ++i)
        if (values[i]) data.push_back({place(i, curve.points[i].strength), percent(*values[i])});
      Json line = series(scene, colour, axis_.kinds ? "circle" : "none", 1, "solid", data);
      line["symbolSize"] = 3;
      line["itemStyle"]["opacity"] = line["lineStyle"]["opacity"] = 0.35;
      line["silent"] = true;
      all.push_back(line);
    }
  }

  const StressAxis& axis_;
  std::vector<const StressCurve*> curves_;
  const std::vector<SeriesStyle>& styles_;
  int index_;
  std::vector<std::string> labels_;
  bool log_ = false, categories_ = false;
};

/// Those of one group: the page has more variants than colours.
std::vector<SeriesStyle> styles_for(const StressPlan& plan, const StressSummary& summary,
                                    const std::string& group) {
  std::vector<Outcome> names;
  for (const StressCurve& curve : summary.curves) {
    if (plan.axes[curve.axis].group != group) continue;
    Outcome o;
    o.variant = curve.variant;
    names.push_back(o);
  }
  return styles_of(names);
}

Chart group_chart(const StressPlan& plan, const StressSummary& summary, const std::string& group) {
  const std::vector<SeriesStyle> styles = styles_for(plan, summary, group);
  std::vector<std::vector<const StressCurve*>> panels;
  std::vector<std::string> legend;
  bool failed = false;
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    if (plan.axes[a].group != group) continue;
    panels.emplace_back();
    for (const StressCurve& curve : summary.curves) {
      if (curve.axis != a) continue;
      panels.back().push_back(&curve);
      for (const CurvePoint& p : curve.points) failed = failed || p.failed;
      for (const std::string& name : {fine(curve.variant), coarse(curve.variant)})
        if (std::find(legend.begin(), legend.end(), name) == legend.end()) legend.push_back(name);
    }
  }
  legend.insert(legend.end(), {kPromised, kTrue});
  if (failed) legend.emplace_back("failed");
  const int rows = (int(panels.size()) + 1) / 2, top = kTop + 34 + legend_room(legend);
  Chart chart{"stress--" + group, group, kWidth, top + rows * kPanelRow, {}};
  chart.option = base_option(plan.title + ": " + group, legend);
  for (const char* part : {"grid", "xAxis", "yAxis"}) chart.option[part] = Json::array();
  int index = 0;
  for (const auto& curves : panels) {
    Panel(plan.axes[curves.front()->axis], curves, styles, index)
        .add_to(chart.option, top + index / 2 * kPanelRow);
    ++index;
  }
  return chart;
}

/// What every promise keeps, a row each.
Chart marks_chart(const StressPlan& plan, const StressSummary& summary) {
  const int rows = int(summary.marks.size());
  const std::vector<std::string> legend = {"mean over scenes", "worst scene"};
  Chart chart{"stress--marks", "marks", kWidth, 130 + 30 * rows, {}};
  chart.option =
      base_option(plan.title + ": share of the clean F-score at 0.25 % that is kept", legend);
  chart.option["grid"] = {{"left", 420}, {"right", 50}, {"top", 74}, {"bottom", 44}};
  Json names = Json::array(), means = Json::array(), worst = Json::array();
  for (const MarkResult& m : summary.marks) {
    names.push_back(m.text);
    means.push_back(m.mean ? Json(percent(*m.mean)) : Json("-"));
    worst.push_back({{"value", m.worst ? Json(percent(*m.worst)) : Json("-")},
                     {"itemStyle", {{"color", m.pass ? "#009e73" : "#b00020"}}}});
  }
  const std::vector<int> ticks = {0, 20, 40, 60, 80, 100};
  chart.option["yAxis"] = {{"type", "category"},
                           {"inverse", true},
                           {"data", names},
                           {"axisTick", {{"show", false}}},
                           {"axisLabel", {{"color", "#222"}, {"interval", 0}}}};
  chart.option["xAxis"] = {{"type", "value"},
                           {"min", 0},
                           {"max", 105},
                           {"name", "%"},
                           {"axisLabel", {{"color", "#222"}, {"customValues", ticks}}},
                           {"axisTick", {{"show", true}, {"customValues", ticks}}}};
  Json bars = {{"type", "bar"},
               {"name", legend[0]},
               {"barWidth", 14},
               {"itemStyle", {{"color", "#b9cfe0"}}},
               {"data", means}};
  bars["markLine"] = {
      {"silent", true},
      {"symbol", "none"},
      {"lineStyle", {{"color", "#444"}, {"type", "dashed"}}},
      {"label", {{"formatter", concat(100 * plan.kept, " %")}, {"position", "start"}}},
      {"data", Json::array({{{"xAxis", 100 * plan.kept}}})}};
  Json points = {{"type", "scatter"},
                 {"name", legend[1]},
                 {"symbolSize", 11},
                 {"itemStyle", {{"color", "#444"}}},
                 {"z", 4}};
  Json data = Json::array();
  for (std::size_t i = 0; i < worst.size(); ++i)
    if (worst[i]["value"].is_number())
      data.push_back({{"value", {worst[i]["value"], i}}, {"itemStyle", worst[i]["itemStyle"]}});
  points["data"] = data;
  chart.option["series"].push_back(bars);
  chart.option["series"].push_back(points);
  return chart;
}

}  // namespace

std::vector<Chart> stress_charts(const StressPlan& plan, const StressSummary& summary) {
  std::vector<Chart> charts;
  if (!summary.marks.empty()) charts.push_back(marks_chart(plan, summary));
  std::vector<std::string> groups;
  for (const StressAxis& axis : plan.axes)
    if (std::find(groups.begin(), groups.end(), axis.group) == groups.end())
      groups.push_back(axis.group);
  for (const std::string& group : groups) charts.push_back(group_chart(plan, summary, group));
  return charts;
}

}  // namespace photohull::chart
