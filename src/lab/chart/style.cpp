#include "lab/chart/style.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "lab/chart/label_layout.h"

namespace photohull::chart {
namespace {

// Okabe and Ito's colours for all kinds of colour vision, yellow last because the page is white.
constexpr std::array kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                 "#56b4e9", "#000000", "#8a8a8a", "#b8a800"};
constexpr std::array kSymbols = {
    "circle",
    "rect",
    "triangle",
    "diamond",
    "path://M0,0L10,0L5,9Z",                                         // triangle on its tip
    "path://M3,0L7,0L7,3L10,3L10,7L7,7L7,10L3,10L3,7L0,7L0,3L3,3Z",  // cross
    "path://M2.5,0L7.5,0L10,5L7.5,10L2.5,10L0,5Z",                   // hexagon
    "path://M5,0L6.5,3.5L10,3.8L7.3,6.2L8.1,10L5,8L1.9,10L2.7,6.2L0,3.8L3.5,3.5Z"};  // star
constexpr const char* kDashes = "path://M0,4L6,4L6,6L0,6ZM9,4L15,4L15,6L9,6Z";

/// These digits times powers of ten, between two positive numbers.
std::vector<double> ticks_of(const std::vector<double>& digits, double low, double high) {
  std::vector<double> ticks;
  for (int power = int(std::floor(std::log10(low))); power <= std::log10(high); ++power)
    for (const double digit : digits) {
      // Negative powers by division: 2 / 10 is 0.2, 2 * 0.1 is not.
      const double scale = std::pow(10.0, std::abs(power));
      const double tick = power < 0 ? digit / scale : digit * scale;
      if (tick >= low && tick <= high) ticks.push_back(tick);
    }
  return ticks;
}

}  // namespace

std::vector<SeriesStyle> styles_of(const std::vector<Outcome>& outcomes) {
  std::vector<SeriesStyle> styles;
  for (const bool external : {false, true}) {
    std::size_t marker = 0;
    for (const Outcome& o : outcomes) {
      const auto same = [&](const SeriesStyle& s) {
        return s.name == o.variant && s.external == o.external;
      };
      if (o.external != external || std::any_of(styles.begin(), styles.end(), same)) continue;
      const std::string colour = kColours[styles.size() % kColours.size()];
      const std::string symbol = kSymbols[marker % kSymbols.size()];
      styles.push_back({o.variant, colour, symbol, external});
      ++marker;
    }
  }
  return styles;
}

const SeriesStyle& style_of(const std::vector<SeriesStyle>& styles, const Outcome& outcome) {
  const auto at = std::find_if(styles.begin(), styles.end(), [&](const SeriesStyle& s) {
    return s.name == outcome.variant && s.external == outcome.external;
  });
  PHOTOHULL_CHECK(at != styles.end());
  return *at;
}

std::string shown(double value) {
  char text[40];
  const double size = std::abs(value);
  std::snprintf(text, sizeof text, size >= 1000 ? "%.0f" : size >= 10 ? "%.4g" : "%.3g", value);
  return text;
}

std::string shown(const std::optional<double>& value) { return value ? shown(*value) : "-"; }

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) {
    if (c == '&')
      html += "&amp;";
    else if (c == '<')
      html += "&lt;";
    else if (c == '>')
      html += "&gt;";
    else if (c == '"')
      html += "&quot;";
    else if (c == '{')
      html += "&#123;";  // a template's brace
    else if (c == '\'')
      html += "&#39;";
    else
      html += c;
  }
  return html;
}

std::vector<double> log_ticks(double low, double high) {
  std::vector<double> ticks = ticks_of({1, 2, 5}, low, high);
  if (ticks.size() < 3) ticks = ticks_of({1, 1.5, 2, 3, 4, 5, 6, 7, 8, 9}, low, high);
  return ticks;
}
std::pair<double, double> log_range(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !(v > 0) || !std::isfinite(v); });
  if (values.empty()) return {1, 10};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double room = std::max(1.15, std::pow(*high / *low, 0.06));
  return {*low / room, *high * room};
}

Json log_axis(const std::string& name, double low, double high, const std::vector<double>& ticks) {
  return {{"type", "log"},
          {"name", name},
          {"nameLocation", "middle"},
          {"nameGap", 30},
          {"nameTextStyle", {{"fontSize", 13}, {"color", "#222"}}},
          {"min", low},
          {"max", high},
          {"axisLine", {{"show", true}, {"onZero", false}, {"lineStyle", {{"color", "#444"}}}}},
          {"axisLabel", {{"customValues", ticks}, {"color", "#222"}, {"hideOverlap", true}}},
          {"axisTick", {{"customValues", ticks}, {"show", true}}},
          {"splitLine", {{"show", false}}}};
}

Json item_style(const SeriesStyle& style) {
  if (!style.external) return {{"color", style.colour}, {"opacity", 1}};
  return {{"color", "#fff"}, {"borderColor", style.colour}, {"borderWidth", 2}, {"opacity", 1}};
}

int legend_room(const std::vector<std::string>& legend) {
  constexpr double kWidth = 900, kEntry = 36, kRow = 29;
  int rows = 1;
  double used = 0;
  for (const std::string& name : legend) {
    const double width = text_size(name, 12).x + kEntry;
    if (used > 0 && used + width > kWidth) {
      ++rows;
      used = 0;
    }
    used += width;
  }
  return int(kRow) * std::max(0, rows - 2);
}

Json base_option(const std::string& title, const std::vector<std::string>& legend) {
  Json entries = Json::array();
  for (const std::string& name : legend) {
    entries.push_back({{"name", name}});
    if (name == kFrontName) entries.back()["icon"] = kDashes;
  }
  return {{"animation", false},
          {"backgroundColor", "#ffffff"},
          {"textStyle", {{"fontFamily", "sans-serif"}}},
          {"title", Json::array({{{"text", title},
                                  {"left", "center"},
                                  {"top", 8},
                                  {"textStyle", {{"fontSize", 17}, {"color", "#111"}}}}})},
          {"legend",
           {{"data", entries},
            {"itemWidth", 15},
            {"itemHeight", 11},
            {"top", 38},
            {"left", "center"},
            {"width", 900},
            {"itemGap", 16},
            {"textStyle", {{"fontSize", 12}, {"color", "#222"}}}}},
          {"tooltip", {{"trigger", "item"}, {"confine", true}}},
          {"series", Json::array()}};
}

std::string hover_text(const Outcome& o) {
  std::string html = "<b>" + escaped(o.label()) + "</b>";
  html += o.scenes > 1 ? concat("<br>mean over ", o.covered, " of ", o.scenes, " scenes")
                       : "<br>" + escaped(o.scene);
  if (o.failed)
    html += "<br><b>failed</b>: " + escaped(o.failure);
  else if (o.failed_scenes)
    html += concat("<br>failed in ", o.failed_scenes, " scenes");
  html += "<br>CPU time: " + shown(o.cpu_seconds) + " s<br>wall time: " + shown(o.wall_seconds) +
          " s<br>peak memory: " + shown(o.peak_mb) + " MiB";
  for (const auto& [threshold, f] : o.figures.f_percent)
    html += "<br>F at " + shown(threshold) + " %: " + shown(f) + " %";
  if (o.figures.accuracy_percent)
    html += "<br>90 % of the mesh within " + shown(*o.figures.accuracy_percent) + " %";
  if (o.figures.completeness_percent)
    html += "<br>completeness at 0.5 %: " + shown(*o.figures.completeness_percent) + " %";
  if (o.figures.triangles) html += concat("<br>triangles: ", *o.figures.triangles);
  return html;
}

Json failed_series(Json data) {
  return {{"type", "scatter"},
          {"name", "failed"},
          {"symbol", kFailedSymbol},
          {"symbolSize", kMarker},
          {"clip", false},
          {"z", 5},
          {"itemStyle", {{"color", "none"}, {"borderColor", kFailedColour}, {"borderWidth", 2}}},
          {"data", std::move(data)}};
}

}  // namespace photohull::chart
