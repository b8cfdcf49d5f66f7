#include "chart/style.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "core/error.h"

namespace photohull::chart {
namespace {

// Okabe and Ito's colours for all kinds of colour vision, yellow last because the page is white.
constexpr std::array kColours = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00",
                                 "#56b4e9", "#000000", "#8a8a8a", "#b8a800"};
constexpr std::array kSymbols = {"circle", "rect", "triangle", "diamond", "pin", "roundRect"};
constexpr std::array kHollow = {"emptyCircle",  "emptyRect", "emptyTriangle",
                                "emptyDiamond", "emptyPin",  "emptyRoundRect"};

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
      const std::string symbol =
          external ? kHollow[marker % kHollow.size()] : kSymbols[marker % kSymbols.size()];
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
  if (std::abs(value) >= 100)
    std::snprintf(text, sizeof text, "%.0f", value);
  else
    std::snprintf(text, sizeof text, "%.3g", value);
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
  std::vector<double> ticks;
  for (int power = int(std::floor(std::log10(low))); power <= std::log10(high); ++power)
    for (const double digit : {1.0, 2.0, 5.0}) {
      // Negative powers by division: 2 / 10 is 0.2, 2 * 0.1 is not.
      const double scale = std::pow(10.0, std::abs(power));
      const double tick = power < 0 ? digit / scale : digit * scale;
      if (tick >= low && tick <= high) ticks.push_back(tick);
    }
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

Json base_option(const std::string& title, const std::vector<std::string>& legend) {
  return {{"animation", false},
          {"backgroundColor", "#ffffff"},
          {"textStyle", {{"fontFamily", "sans-serif"}}},
          {"title", Json::array({{{"text", title},
                                  {"left", "center"},
                                  {"top", 8},
                                  {"textStyle", {{"fontSize", 17}, {"color", "#111"}}}}})},
          {"legend",
           {{"data", legend},
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
