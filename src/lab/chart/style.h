// What all charts have in common: colours, markers, axes, texts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lab/chart/json_fields.h"
#include "lab/chart/outcome.h"

namespace photohull::chart {

/// Colour and marker of a variant, the same in all charts that share a list of styles.
struct SeriesStyle {
  std::string name;
  std::string colour;     ///< "#rrggbb"
  std::string symbol;     ///< of ECharts
  bool external = false;  ///< drawn hollow
};

/// The program's own variants first, then the external tools, each in order of appearance.
std::vector<SeriesStyle> styles_of(const std::vector<Outcome>& outcomes);
const SeriesStyle& style_of(const std::vector<SeriesStyle>& styles, const Outcome& outcome);

inline constexpr const char* kFailedColour = "#b00020";
inline constexpr const char* kFailedSymbol = "path://M0,0L10,10M10,0L0,10";
inline constexpr const char* kFrontName = "Pareto front";
inline constexpr double kMarker = 11;  ///< pixels

/// Three or four significant digits: "0.0348", "12.35", "18304".
std::string shown(double value);
std::string shown(const std::optional<double>& value);  ///< "-" for none
/// Text of HTML, with its special characters escaped.
std::string escaped(std::string_view text);

/// Round numbers between two positive ones: 1, 2 and 5 times powers of ten, or more where that
/// gives few.
std::vector<double> log_ticks(double low, double high);
/// Positive bounds that leave some room around positive values, for a logarithmic axis.
std::pair<double, double> log_range(std::vector<double> values);

/// A logarithmic axis with these ticks.
Json log_axis(const std::string& name, double low, double high, const std::vector<double>& ticks);
/// How the points of a variant are filled.
Json item_style(const SeriesStyle& style);
/// Pixels that a legend needs beyond the two rows that every chart has room for.
int legend_room(const std::vector<std::string>& legend);
/// What every chart's option starts with.
Json base_option(const std::string& title, const std::vector<std::string>& legend);
/// The figures of an outcome as HTML, for people who point at it.
std::string hover_text(const Outcome& outcome);
/// A series of crosses for what failed; `data` as ECharts has it.
Json failed_series(Json data);

}  // namespace photohull::chart
