#include "cli/lab/draw_reliability.h"

#include <cstdio>

#include "lab/chart/png.h"
#include "lab/chart/reliability_chart.h"
#include "lab/chart/svg_renderer.h"

namespace photohull::cli {

std::string draw_reliability(const std::string& mesh, const eval::Reliability& r, bool as_svg) {
  chart::ReliabilityCurve curve{mesh, {}};
  for (const eval::ReliabilityBin& b : r.bins)
    curve.bins.push_back({b.low, b.high, b.count, b.confidence, b.within});
  char title[80];
  std::snprintf(title, sizeof title, "Within %.4g of the truth: calibration error %.3f", r.distance,
                r.calibration_error);
  const chart::Chart chart = chart::reliability_chart(title, {curve});
  const std::string svg = chart::SvgRenderer().render(chart.option, chart.width, chart.height);
  return as_svg ? svg : chart::to_png(svg, 2 * chart.width, 2 * chart.height);
}

}  // namespace photohull::cli
