#include "lab/chart/reliability_chart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "lab/chart/png.h"
#include "lab/chart/svg_renderer.h"

namespace photohull::chart {
namespace {

using testing::HasSubstr;

const std::vector<ReliabilityCurve> kCurves = {
    {"first", {{0, 0.5, 1, 0.25, 0.125}, {0.5, 1, 3, 0.75, 1}}},
    {"second", {{0, 0.5, 0, 0, 0}, {0.5, 1, 7, 0.9, 0.8}}}};

TEST(ReliabilityChart, ShowsEveryBinThatHoldsSomething) {
  const Chart chart = reliability_chart("Title", kCurves);
  const Json& series = chart.option["series"];
  ASSERT_EQ(series.size(), 5u);  // the diagonal, and two of each
  EXPECT_EQ(series[1]["data"], Json::parse("[[0.25, 0.125], [0.75, 1.0]]"));
  EXPECT_EQ(series[2]["data"], Json::parse("[[0.25, 25.0], [0.75, 75.0]]")) << "percent";
  EXPECT_EQ(series[3]["data"], Json::parse("[[0.9, 0.8]]"));
  EXPECT_EQ(series[4]["data"], Json::parse("[[0.25, 0.0], [0.75, 100.0]]"));
}

TEST(ReliabilityChart, EChartsAndLibrsvgDrawIt) {
  const Chart chart = reliability_chart("A title with <marks> & \"quotes\"", kCurves);
  const std::string svg = SvgRenderer().render(chart.option, chart.width, chart.height);
  for (const char* part : {"<svg", "first", "second", "perfect calibration", "&lt;marks&gt;"})
    EXPECT_THAT(svg, HasSubstr(part));
  EXPECT_EQ(to_png(svg, 64, 72).substr(1, 3), "PNG");
  EXPECT_THROW(to_png("no picture", 64, 72), Error);
}

}  // namespace
}  // namespace photohull::chart
