#include "lab/chart/sampling_chart.h"

#include <gtest/gtest.h>

#include "lab/chart/svg_renderer.h"

namespace photohull::chart {
namespace {

std::vector<SamplingPanel> panels() {
  const SamplingCurve plain{"mipmap", "", {{0.25, 9.5}, {1, 1.1}, {32, 0.7}}};
  const SamplingCurve finer{"mipmap 8x8", "mipmap", {{0.25, 0.9}, {1, 0.4}, {32, 0.3}}};
  return {{"1 : 1", {plain, finer}}, {"16 : 1", {plain, finer}}};
}

TEST(SamplingChart, HasAnAxisPairAndALineAtOnePercentForEachPanel) {
  const Chart chart = sampling_chart("Samplers", panels());
  EXPECT_EQ(chart.option["grid"].size(), 2u);
  EXPECT_EQ(chart.option["series"].size(), 6u);
  EXPECT_EQ(chart.option["xAxis"][0]["min"], 0.25);
  EXPECT_EQ(chart.option["xAxis"][1]["max"], 32);
  EXPECT_EQ(chart.option["yAxis"][0]["min"], 0.1);
  EXPECT_EQ(chart.option["yAxis"][1]["max"], 10);
}

TEST(SamplingChart, SupersampledCurvesLookLikeTheirSamplersDashed) {
  const Chart chart = sampling_chart("Samplers", panels());
  const auto& series = chart.option["series"];
  EXPECT_EQ(series[1]["lineStyle"]["color"], series[2]["lineStyle"]["color"]);
  EXPECT_EQ(series[1]["lineStyle"]["type"], "solid");
  EXPECT_EQ(series[2]["lineStyle"]["type"], "dashed");
}

TEST(SamplingChart, IsDrawn) {
  const Chart chart = sampling_chart("Samplers", panels());
  const std::string svg = SvgRenderer().render(chart.option, chart.width, chart.height);
  EXPECT_NE(svg.find("16 : 1"), std::string::npos);
  EXPECT_NE(svg.find("mipmap 8x8"), std::string::npos);
}

}  // namespace
}  // namespace photohull::chart
