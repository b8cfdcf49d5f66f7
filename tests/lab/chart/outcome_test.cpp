#include "lab/chart/outcome.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace photohull::chart {
namespace {

using testing::ElementsAre;
using testing::Optional;

Outcome outcome(const std::string& scene, const std::string& variant, double cpu, double f) {
  Outcome o;
  o.scene = scene;
  o.variant = variant;
  o.cpu_seconds = cpu;
  o.figures.f_percent[0.25] = f;
  return o;
}

Outcome failed(const std::string& scene, const std::string& variant) {
  Outcome o = outcome(scene, variant, 2, 0);
  o.figures = {};
  o.failed = true;
  return o;
}

TEST(MeansOver, AveragesEachVariantOverTheScenes) {
  const auto means =
      means_over({outcome("a", "x", 10, 80), outcome("a", "y", 1, 50), outcome("b", "x", 30, 90),
                  outcome("b", "y", 3, 60), outcome("c", "x", 999, 0)},
                 {"a", "b"});
  ASSERT_EQ(means.size(), 2u);
  EXPECT_EQ(means[0].label(), "x");
  EXPECT_THAT(means[0].cpu_seconds, Optional(20.0));
  EXPECT_THAT(means[0].figures.f_at(0.25), Optional(85.0));
  EXPECT_TRUE(means[0].complete());
  EXPECT_THAT(means[1].figures.f_at(0.25), Optional(55.0));
}

TEST(MeansOver, CountsAFailureAsZeroAndSaysSo) {
  const auto means = means_over({outcome("a", "x", 10, 80), failed("b", "x")}, {"a", "b"});
  EXPECT_THAT(means[0].figures.f_at(0.25), Optional(40.0));
  EXPECT_EQ(means[0].failed_scenes, 1);
  EXPECT_FALSE(means[0].failed);
  EXPECT_FALSE(means[0].complete());
  EXPECT_TRUE(means_over({failed("a", "x"), failed("b", "x")}, {"a", "b"})[0].failed);
}

TEST(MeansOver, TellsWhatIsMissing) {
  const auto means = means_over({outcome("a", "x", 10, 80)}, {"a", "b", "c"});
  EXPECT_EQ(means[0].covered, 1);
  EXPECT_EQ(means[0].scenes, 3);
  EXPECT_FALSE(means[0].complete());
}

TEST(MeansOver, KeepsAToolApartFromAVariantOfItsName) {
  Outcome tool = outcome("a", "x", 5, 70);
  tool.external = true;
  EXPECT_EQ(means_over({outcome("a", "x", 10, 80), tool}, {"a", "b"}).size(), 2u);
}

TEST(FrontOf, LeavesOutFailuresAndPartialMeans) {
  std::vector<Outcome> all = {outcome("a", "slow", 100, 90), outcome("a", "fast", 1, 50),
                              failed("a", "broken"), outcome("a", "beaten", 120, 80)};
  EXPECT_THAT(front_of(all, 0.25), ElementsAre(1, 0));
  all[1].scenes = 2;  // seen in one of two
  EXPECT_THAT(front_of(all, 0.25), ElementsAre(0));
  EXPECT_THAT(front_of(all, 0.1), ElementsAre());
}

TEST(FiguresOfEvaluation, TakesWhatCamerasSee) {
  const Figures f = figures_of_evaluation(Json::parse(R"({
      "accuracy_pct_diag": 9, "f": [{"t": 0.0025, "f": 0.1}], "completeness": 0.97,
      "recon_faces": 1200, "seen": {"accuracy_pct_diag": 0.5, "f": [{"t": 0.0025, "f": 0.9}]}})"));
  EXPECT_THAT(f.f_at(0.25), Optional(90.0));
  EXPECT_THAT(f.accuracy_percent, Optional(0.5));
  EXPECT_THAT(f.completeness_percent, Optional(97.0));
  EXPECT_EQ(f.triangles, 1200);
  EXPECT_FALSE(f.f_at(0.5));
}

TEST(FiguresOfEvaluation, RefusesOneWithoutAnFScore) {
  EXPECT_ANY_THROW(figures_of_evaluation(Json::parse("{}")));
  EXPECT_ANY_THROW(figures_of_evaluation(Json::parse("[1]")));
  EXPECT_ANY_THROW(figures_of_evaluation(Json::parse(R"({"seen": {"f": [{"t": "x"}]}})")));
}

}  // namespace
}  // namespace photohull::chart
