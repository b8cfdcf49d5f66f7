#include "lab/chart/chart_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "example_outcomes.h"

namespace photohull::chart {
namespace {

using test::example_outcomes;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> ids(const std::vector<Chart>& charts) {
  std::vector<std::string> found;
  for (const Chart& c : charts) found.push_back(c.id);
  return found;
}

const Chart& chart(const std::vector<Chart>& charts, const std::string& id) {
  for (const Chart& c : charts)
    if (c.id == id) return c;
  throw std::runtime_error("no chart " + id);
}

const Json& series(const Chart& chart, const std::string& name) {
  for (const Json& s : chart.option["series"])
    if (s["name"] == name) return s;
  throw std::runtime_error("no series " + name);
}

TEST(MakeCharts, DrawsEverySceneAndTheMean) {
  const auto charts = make_charts(example_outcomes(), {"ball", "cube"}, {}, 0.25);
  for (const std::string group : {"mean", "ball", "cube"})
    for (const std::string kind :
         {"speed-accuracy", "wall-accuracy", "accuracy-resolution", "cost-resolution", "stages"})
      EXPECT_THAT(ids(charts), Contains(kind + "--" + group));
  EXPECT_EQ(charts.size(), 15u);
}

TEST(MakeCharts, OneSceneHasNoMean) {
  EXPECT_THAT(ids(make_charts(example_outcomes(), {"ball"}, {}, 0.25)),
              Not(Contains("speed-accuracy--mean")));
}

TEST(MakeCharts, MarkersAndColoursTellVariantsApart) {
  const auto styles = styles_of(example_outcomes());
  std::set<std::string> colours;
  std::set<std::pair<std::string, bool>> symbols;  // external ones are hollow
  for (const SeriesStyle& s : styles) {
    colours.insert(s.colour);
    symbols.emplace(s.symbol, s.external);
  }
  EXPECT_EQ(colours.size(), styles.size());
  EXPECT_EQ(symbols.size(), styles.size());
}

TEST(SpeedChart, PutsPointsWhereTheyBelong) {
  const auto charts = make_charts(example_outcomes(), {"ball", "cube"}, {}, 0.25);
  const Chart& c = chart(charts, "speed-accuracy--ball");
  const Json& hull = series(c, "hull");
  ASSERT_EQ(hull["data"].size(), 3u);
  EXPECT_EQ(hull["data"][0]["value"][0], 1.0);   // CPU seconds
  EXPECT_EQ(hull["data"][0]["value"][1], 40.0);  // what lacks to 100 %
  EXPECT_THAT(hull["data"][0]["tooltip"]["formatter"].get<std::string>(),
              HasSubstr("F at 0.25 %: 60 %"));
  EXPECT_EQ(series(c, "peer")["data"].size(), 1u);
  EXPECT_EQ(series(c, "failed")["data"].size(), 1u);
  EXPECT_EQ(c.option["xAxis"]["type"], "log");
}

TEST(SpeedChart, ShowsTheTimeToWaitBesideTheWork) {
  std::vector<Outcome> outcomes = example_outcomes();
  for (Outcome& o : outcomes) o.wall_seconds.reset();
  const auto without = make_charts(outcomes, {"ball"}, {}, 0.25);
  EXPECT_THAT(ids(without), Not(Contains("wall-accuracy--ball")));
  for (Outcome& o : outcomes) o.wall_seconds = 0.5 * *o.cpu_seconds;
  const auto charts = make_charts(outcomes, {"ball"}, {}, 0.25);
  const Chart& c = chart(charts, "wall-accuracy--ball");
  EXPECT_EQ(series(c, "hull")["data"][0]["value"][0], 0.5);
  EXPECT_EQ(series(c, "Pareto front")["data"].size(), 5u);
  EXPECT_THAT(c.option["xAxis"]["name"].get<std::string>(), HasSubstr("wall"));
}

TEST(SpeedChart, ShowsTheFront) {
  const auto charts = make_charts(example_outcomes(), {"ball", "cube"}, {}, 0.25);
  const Json& front = series(chart(charts, "speed-accuracy--ball"), "Pareto front");
  // hull 50, hull 100, hull 200, carving 200 (the peer is slower and worse), and the line's end.
  ASSERT_EQ(front["data"].size(), 5u);
  EXPECT_EQ(front["data"][3][1], 5.0);
}

TEST(AccuracyChart, FitsTheSlope) {
  const auto charts = make_charts(example_outcomes(), {"ball"}, {}, 0.25);
  const Chart& c = chart(charts, "accuracy-resolution--ball");
  ASSERT_FALSE(c.option["graphic"].empty());
  EXPECT_EQ(c.option["graphic"][0]["style"]["text"], "hull: error ∝ N^−1.00");
}

TEST(CostChart, FitsTheExponents) {
  const auto charts = make_charts(example_outcomes(), {"ball"}, {}, 0.25);
  std::vector<std::string> texts;
  for (const Json& g : chart(charts, "cost-resolution--ball").option["graphic"])
    texts.push_back(g["style"]["text"]);
  EXPECT_THAT(texts, Contains("hull: time ∝ N^2.00"));
  EXPECT_THAT(texts, Contains("hull: memory ∝ N^1.00"));
}

TEST(StageChart, SharesAddUpToTheWhole) {
  const auto charts = make_charts(example_outcomes(), {"ball"}, {}, 0.25);
  const Chart& c = chart(charts, "stages--ball");
  double sum = 0;
  for (const Json& s : c.option["series"]) sum += s["data"][0]["value"].get<double>();
  EXPECT_NEAR(sum, 100, 0.01);
  EXPECT_THAT(c.option["yAxis"]["data"].dump(), HasSubstr("carving 100 (failed)"));
}

TEST(LogTicks, AreRoundNumbersWithinTheRange) {
  EXPECT_THAT(log_ticks(0.15, 60), testing::ElementsAre(0.2, 0.5, 1, 2, 5, 10, 20, 50));
}

}  // namespace
}  // namespace photohull::chart
