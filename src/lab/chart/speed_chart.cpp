#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "lab/chart/chart_set.h"
#include "lab/chart/label_layout.h"

namespace photohull::chart {
namespace {

constexpr double kLeft = 88, kRight = 40, kBottom = 64;  ///< margins, pixels
constexpr double kPlot = 480;                            ///< height between the margins
constexpr double kFont = 11;
// F-scores that get a line; what lacks to 100 % falls about evenly on a logarithmic scale.
constexpr double kLevels[] = {0,  25, 50,   70,   80,   90,    95,    97,
                              98, 99, 99.5, 99.8, 99.9, 99.95, 99.98, 99.99};

/// A position on the chart. The vertical axis is what lacks to 100 %, logarithmic and turned over.
struct Point {
  const Outcome* outcome;
  double seconds, lack;
};

class SpeedChart {
 public:
  SpeedChart(const ChartInput& input, TimeKind kind) : in_(input), kind_(kind) {
    for (const Outcome& o : in_.outcomes) {
      const auto f = o.failed ? 0.0 : o.figures.f_at(in_.threshold_percent);
      if (const auto& seconds = o.seconds(kind); seconds && f)
        points_.push_back({&o, std::max(*seconds, 1e-3), std::max(100 - *f, 0.01)});
    }
    set_ranges();
  }

  Chart chart() {
    std::vector<std::string> legend;
    for (const SeriesStyle& s : in_.styles)
      if (uses(s)) legend.push_back(s.name);
    legend.push_back(kFrontName);
    if (any_failed()) legend.push_back("failed");
    top_edge_ += legend_room(legend);
    const bool wall = kind_ == TimeKind::kWall;
    Chart c{concat(wall ? "wall" : "speed", "-accuracy--", in_.group),
            in_.group,
            1000,
            int(top_edge_ + kPlot + kBottom),
            {}};
    c.option = base_option(
        concat(wall ? "Time to wait" : "Speed", " against accuracy: ", in_.heading), legend);
    c.option["grid"] = {
        {"left", kLeft}, {"right", kRight}, {"top", top_edge_}, {"bottom", kBottom}};
    c.option["xAxis"] =
        log_axis(wall ? "wall time (s, logarithmic)" : "CPU time (s, user + system, logarithmic)",
                 low_, high_, log_ticks(low_, high_));
    c.option["yAxis"] = y_axis();
    place();
    c.option["series"].push_back(front_series());
    for (const SeriesStyle& s : in_.styles)
      if (uses(s)) c.option["series"].push_back(series(s));
    if (any_failed()) c.option["series"].push_back(failed());
    c.option["graphic"] = leaders_;
    return c;
  }

 private:
  void set_ranges() {
    std::vector<double> seconds;
    double worst = 20, best = 10;
    for (const Point& p : points_) {
      seconds.push_back(p.seconds);
      worst = std::max(worst, p.lack);
      best = std::min(best, p.lack);
    }
    std::tie(low_, high_) = log_range(seconds);
    if (high_ / low_ < 4) {
      low_ /= 2;
      high_ *= 2;
    }
    bottom_ = 100;
    for (const double level : kLevels)
      if (100 - level >= worst * 1.1) bottom_ = 100 - level;
    top_ = best / 1.25;
    for (const double level : kLevels)
      if (100 - level <= best / 1.1) {
        top_ = 100 - level;
        break;
      }
  }

  bool uses(const SeriesStyle& s) const {
    return std::any_of(points_.begin(), points_.end(), [&](const Point& p) {
      return p.outcome->variant == s.name && p.outcome->external == s.external;
    });
  }
  bool any_failed() const {
    return std::any_of(points_.begin(), points_.end(),
                       [](const Point& p) { return p.outcome->failed; });
  }

  Json y_axis() const {
    Json axis = log_axis(concat("F-score at ", shown(in_.threshold_percent),
                                " % of the diagonal (%, stretched towards 100)"),
                         top_, bottom_, {});
    axis["inverse"] = true;
    axis["nameGap"] = 58;
    axis["axisLabel"] = {{"show", false}};
    axis["axisTick"] = {{"show", false}};
    return axis;
  }

  glm::dvec2 pixel(const Point& p) const { return pixel_of(p.seconds, p.lack); }
  glm::dvec2 pixel_of(double seconds, double lack) const {
    const double x = std::log(seconds / low_) / std::log(high_ / low_);
    const double y = std::log(lack / top_) / std::log(bottom_ / top_);
    return {kLeft + x * (1000 - kLeft - kRight), top_edge_ + y * kPlot};
  }

  std::string label(const Outcome& o) const {
    std::string text = o.label();
    if (o.failed) return text + " failed";
    if (o.covered < o.scenes) text += concat(" (", o.covered, " of ", o.scenes, " scenes)");
    if (o.failed_scenes) text += concat(" (", o.failed_scenes, " failed)");
    return text;
  }

  /// Labels of points on the front are placed first.
  void place() {
    std::vector<std::size_t> order;
    front_ = front_of(in_.outcomes, in_.threshold_percent, kind_);
    const auto on_front = [&](const Point& p) {
      const auto i = std::size_t(p.outcome - in_.outcomes.data());
      return std::find(front_.begin(), front_.end(), i) != front_.end();
    };
    for (const bool first : {true, false})
      for (std::size_t i = 0; i < points_.size(); ++i)
        if (on_front(points_[i]) == first) order.push_back(i);
    std::vector<LabelRequest> requests;
    for (const std::size_t i : order)
      requests.push_back({pixel(points_[i]), text_size(label(*points_[i].outcome), kFont)});
    const auto places = find_places(requests);
    labels_.assign(points_.size(), Json{{"show", false}});
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (!places[k]) continue;
      const Point& p = points_[order[k]];
      const glm::dvec2 offset = *places[k] - requests[k].anchor;
      labels_[order[k]] = {{"show", true},
                           {"position", "inside"},
                           {"offset", {std::round(offset.x), std::round(offset.y)}},
                           {"formatter", label(*p.outcome)},
                           {"fontSize", kFont},
                           {"color", p.outcome->failed ? kFailedColour : "#222"},
                           {"textBorderColor", "#fff"},
                           {"textBorderWidth", 2}};
      add_leader(requests[k], *places[k]);
    }
  }

  /// Labels keep clear of all lines; those that cannot may lie on lines of equal quality.
  std::vector<std::optional<glm::dvec2>> find_places(
      const std::vector<LabelRequest>& requests) const {
    const Rect area{kLeft + 2, top_edge_ - 14, 998, top_edge_ + kPlot + 8};
    const std::vector<Rect> front = front_boxes();
    std::vector<Rect> obstacles = front;
    for (const double level : kLevels) {
      const double y = pixel_of(low_, 100 - level).y;
      if (100 - level <= bottom_ * 1.0001 && 100 - level >= top_ * 0.9999)
        obstacles.push_back({kLeft, y - 0.5, 1000 - kRight, y + 0.5});
    }
    auto places = place_labels(requests, area, kMarker, obstacles);
    std::vector<LabelRequest> left;
    obstacles = front;
    for (std::size_t i = 0; i < requests.size(); ++i) {
      if (!places[i]) left.push_back(requests[i]);
      const glm::dvec2 half = 0.5 * (places[i] ? requests[i].size : glm::dvec2(kMarker));
      const glm::dvec2 at = places[i] ? *places[i] : requests[i].anchor;
      obstacles.push_back({at.x - half.x, at.y - half.y, at.x + half.x, at.y + half.y});
      const glm::dvec2 marker = requests[i].anchor;
      obstacles.push_back({marker.x - kMarker / 2, marker.y - kMarker / 2, marker.x + kMarker / 2,
                           marker.y + kMarker / 2});
    }
    const auto second = place_labels(left, area, kMarker, obstacles);
    std::size_t next = 0;
    for (auto& place : places)
      if (!place) place = second[next++];
    return places;
  }

  /// The front's line, as thin boxes that labels keep clear of.
  std::vector<Rect> front_boxes() const {
    std::vector<Rect> boxes;
    for (std::size_t k = 0; k < front_.size(); ++k) {
      const glm::dvec2 at = front_pixel(k);
      const bool last = k + 1 == front_.size();
      const glm::dvec2 next = last ? glm::dvec2(1000 - kRight, at.y) : front_pixel(k + 1);
      boxes.push_back({at.x, at.y - 2, next.x, at.y + 2});
      if (!last) boxes.push_back({next.x - 2, next.y, next.x + 2, at.y});
    }
    return boxes;
  }
  glm::dvec2 front_pixel(std::size_t k) const {
    const Outcome* o = &in_.outcomes[front_[k]];
    return pixel(*std::find_if(points_.begin(), points_.end(),
                               [&](const Point& p) { return p.outcome == o; }));
  }

  /// A thin line from a label to its point where they are not neighbours.
  void add_leader(const LabelRequest& r, const glm::dvec2& place) {
    const glm::dvec2 near = glm::clamp(r.anchor, place - 0.5 * r.size, place + 0.5 * r.size);
    if (glm::length(near - r.anchor) < kMarker + 4) return;
    const glm::dvec2 start = r.anchor + glm::normalize(near - r.anchor) * (0.5 * kMarker + 1);
    leaders_.push_back(
        {{"type", "line"},
         {"silent", true},
         {"z", 1},
         {"shape", {{"x1", start.x}, {"y1", start.y}, {"x2", near.x}, {"y2", near.y}}},
         {"style", {{"stroke", "#999"}, {"lineWidth", 0.8}}}});
  }

  Json datum(std::size_t i) const {
    const Point& p = points_[i];
    Json d = {{"name", p.outcome->label()},
              {"value", {p.seconds, p.lack}},
              {"label", labels_[i]},
              {"tooltip", {{"formatter", hover_text(*p.outcome)}}}};
    if (p.outcome->covered < p.outcome->scenes) d["itemStyle"] = {{"opacity", 0.45}};
    return d;
  }

  Json series(const SeriesStyle& s) const {
    Json data = Json::array();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Outcome& o = *points_[i].outcome;
      if (!o.failed && o.variant == s.name && o.external == s.external) data.push_back(datum(i));
    }
    return {{"type", "scatter"},     {"name", s.name}, {"symbol", s.symbol},
            {"symbolSize", kMarker}, {"z", 4},         {"itemStyle", item_style(s)},
            {"data", data}};
  }

  Json failed() const {
    Json data = Json::array();
    for (std::size_t i = 0; i < points_.size(); ++i)
      if (points_[i].outcome->failed) data.push_back(datum(i));
    return failed_series(data);
  }

  /// The front as the best quality for the money, and the lines of equal quality behind it.
  Json front_series() const {
    Json data = Json::array();
    for (const std::size_t i : front_) {
      const Outcome& o = in_.outcomes[i];
      data.push_back({std::max(*o.seconds(kind_), 1e-3),
                      std::max(100 - *o.figures.f_at(in_.threshold_percent), 0.01)});
    }
    if (!data.empty()) data.push_back({high_, data.back()[1]});
    Json lines = Json::array();
    for (const double level : kLevels)
      if (100 - level <= bottom_ * 1.0001 && 100 - level >= top_ * 0.9999)
        lines.push_back({{"yAxis", 100 - level},
                         {"label", {{"formatter", shown(level) + " %"}, {"position", "start"}}}});
    return {{"type", "line"},
            {"name", kFrontName},
            {"step", "end"},
            {"symbol", "none"},
            {"silent", true},
            {"z", 2},
            {"itemStyle", {{"color", "#777"}}},
            {"lineStyle", {{"color", "#777"}, {"width", 1.6}, {"type", "dashed"}}},
            {"data", data},
            {"markLine",
             {{"silent", true},
              {"symbol", "none"},
              {"z", 1},
              {"label", {{"color", "#222"}, {"fontSize", 12}, {"distance", 6}}},
              {"lineStyle", {{"color", "#ccc"}, {"type", "solid"}, {"width", 0.8}}},
              {"data", lines}}}};
  }

  const ChartInput& in_;
  TimeKind kind_;
  std::vector<Point> points_;
  std::vector<Json> labels_;
  std::vector<std::size_t> front_;
  Json leaders_ = Json::array();
  double low_ = 1, high_ = 10, top_ = 1, bottom_ = 100;
  double top_edge_ = 96;  ///< of the plot, pixels
};

}  // namespace

Chart speed_chart(const ChartInput& input, TimeKind kind) {
  return SpeedChart(input, kind).chart();
}

}  // namespace photohull::chart
