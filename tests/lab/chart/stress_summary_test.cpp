#include "lab/chart/stress_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "lab/chart/stress_charts.h"
#include "lab/chart/stress_report.h"
#include "lab/chart/svg_renderer.h"
#include "support/scratch_folder.h"

namespace photohull::chart {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Optional;

TEST(BreakdownPoint, IsInterpolated) {
  const std::vector<CurveSample> curve = {{0, 1}, {1, 1}, {3, 0.8}, {4, 0.95}};
  EXPECT_THAT(breakdown_point(curve, 0.9, false), Optional(DoubleNear(2, 1e-12)));
  EXPECT_EQ(breakdown_point(curve, 0.7, false), std::nullopt);
  const std::vector<CurveSample> down = {{100, 1}, {10, 1}, {1, 0.8}};
  EXPECT_THAT(breakdown_point(down, 0.9, true), Optional(DoubleNear(std::sqrt(10), 1e-9)));
  EXPECT_THAT(breakdown_point(down, 0.9, false), Optional(DoubleNear(5.5, 1e-12)));
  EXPECT_THAT(breakdown_point({{0, 1}, {1, 0}}, 0.9, true), Optional(DoubleNear(0.1, 1e-12)));
}

StressPlan plan() {
  StressPlan p;
  p.title = "Test <plan>";
  p.scenes = {{"a", {}}, {"b", {}}};
  p.variants = {{"v", {}}, {"w", {}}};
  StressAxis axis;
  axis.name = axis.title = "noise";
  axis.group = "images";
  axis.points = {{1, "1"}, {2, "2"}, {4, "4"}};
  axis.scenes = {0, 1};
  axis.variants = {0};
  axis.marks = {{"up to 1", 0, "v"}, {"up to 2", 1, "v"}};
  p.axes = {axis};
  axis.name = axis.title = "kind";
  axis.kinds = axis.same_mesh = true;
  axis.points = {{1, "grey"}, {2, "clutter"}};
  axis.marks = {{"clutter", 1, "v"}};
  p.axes.push_back(axis);
  return p;
}

StressSample sample(const StressPlan& plan, std::size_t axis, int point, const std::string& scene,
                    double f) {
  StressSample s;
  s.axis = plan.axes[axis].name;
  const StressPoint& p =
      point < 0 ? plan.axes[axis].clean : plan.axes[axis].points[std::size_t(point)];
  s.clean = point < 0;
  s.label = p.label.empty() ? "0" : p.label;
  s.strength = p.strength;
  s.scene = scene;
  s.variant = "v";
  s.run = concat(axis, scene, point);
  s.exit_code = 0;
  s.mesh_hash = concat(scene, f);
  s.figures.f025 = f;
  s.figures.f05 = f + 0.05 * (1 - f);
  s.figures.confidence = 0.9;
  s.figures.within = 0.95;
  return s;
}

std::vector<StressSample> samples(const StressPlan& p) {
  std::vector<StressSample> all;
  const double a[] = {0.8, 0.8, 0.76, 0.4}, b[] = {1, 0.95, 0.88, 0.5};
  for (int i = -1; i < 3; ++i) {
    all.push_back(sample(p, 0, i, "a", a[i + 1]));
    all.push_back(sample(p, 0, i, "b", b[i + 1]));
  }
  const double k[] = {1, 1, 0.5};
  for (int i = -1; i < 2; ++i) all.push_back(sample(p, 1, i, "a", k[i + 1]));
  return all;
}

TEST(Summarize, CurvesAreMeansWithTheirBreakdownPoints) {
  const StressPlan p = plan();
  const StressSummary s = summarize(p, samples(p));
  ASSERT_EQ(s.curves.size(), 2u);
  const StressCurve& curve = s.curves[0];
  ASSERT_EQ(curve.points.size(), 4u);
  EXPECT_THAT(curve.points[2].f025, Optional(DoubleNear(0.82, 1e-12)));
  // Kept by a: 1, 0.95, 0.5; by b: 0.95, 0.88, 0.5.
  EXPECT_THAT(curve.points[2].kept025, Optional(DoubleNear(0.915, 1e-12)));
  EXPECT_THAT(curve.points[2].worst025, Optional(DoubleNear(0.88, 1e-12)));
  EXPECT_EQ(curve.points[2].worst_scene, "b");
  EXPECT_THAT(curve.break025, Optional(DoubleNear(2 + 2 * 0.015 / 0.415, 1e-9)));
  ASSERT_EQ(curve.scenes.size(), 2u);
  EXPECT_THAT(curve.scenes[0].second[3], Optional(0.4));
  EXPECT_EQ(s.curves[1].break025, std::nullopt);
  EXPECT_THAT(s.curves[1].broken_kinds, ElementsAre("clutter"));
  EXPECT_EQ(s.curves[1].points[1].other_mesh, 0);
  EXPECT_EQ(s.curves[1].points[2].other_mesh, 1);
}

TEST(Summarize, MarksAreJudgedByTheWorstSceneUpToTheirStrength) {
  const StressPlan p = plan();
  const StressSummary s = summarize(p, samples(p));
  ASSERT_EQ(s.marks.size(), 3u);
  EXPECT_TRUE(s.marks[0].pass);
  EXPECT_THAT(s.marks[0].worst, Optional(DoubleNear(0.95, 1e-12)));
  EXPECT_FALSE(s.marks[1].pass);
  EXPECT_EQ(s.marks[1].worst_at, "b at 2");
  EXPECT_FALSE(s.marks[2].pass);
  std::vector<StressSample> part = samples(p);
  std::erase_if(part, [](const StressSample& x) { return x.label == "1"; });
  EXPECT_FALSE(summarize(p, part).marks[0].pass) << "what was not measured is not kept";
}

TEST(Summarize, EarlierRunsAreCurvesOfTheirOwnAndJudgeNothing) {
  const StressPlan p = plan();
  std::vector<StressSample> earlier = samples(p);
  for (StressSample& s : earlier) s.variant = "before: v", s.figures.verdict = "good";
  const StressSummary s = summarize(p, samples(p), earlier);
  EXPECT_EQ(s.curves.size(), 4u);
  EXPECT_EQ(s.curves[1].variant, "before: v");
  EXPECT_EQ(s.samples.size(), samples(p).size());
  EXPECT_FALSE(s.verdicts.any);
}

TEST(JudgeVerdicts, CountsEveryRunOnceByWhatItWasCalled) {
  const StressPlan p = plan();
  std::vector<StressSample> all;
  const auto add = [&](double f05, const char* verdict, int exit_code) {
    StressSample s = sample(p, 0, 0, "a", 0.5);
    s.run = concat(all.size());
    s.figures.f05 = f05;
    s.figures.verdict = verdict;
    s.figures.failed = exit_code != 0;
    all.push_back(s);
  };
  add(0.5, "doubtful", 0), add(0.5, "good", 0), add(0, "", 1), add(0.2, "failed", 3);
  add(0.99, "good", 0), add(0.97, "doubtful", 0), add(0.9, "good", 0), add(0.8, "", 0);
  all.push_back(all.front());  // the same run at another place
  const VerdictTable t = judge_verdicts(all);
  EXPECT_TRUE(t.any);
  EXPECT_THAT(t.counts[0], ElementsAre(1, 1, 2, 0));
  EXPECT_THAT(t.counts[1], ElementsAre(1, 0, 0, 1));
  EXPECT_THAT(t.counts[2], ElementsAre(1, 1, 0, 0));
  EXPECT_THAT(t.bad_called, Optional(0.75));
  EXPECT_THAT(t.good_called, Optional(0.5));
}

TEST(StressReport, SamplesReadBackAndTablesAndChartsTellThem) {
  const StressPlan p = plan();
  std::vector<StressSample> some = samples(p);
  some[3].exit_code = 3;
  some[3].figures.failed = true;
  some[3].figures.verdict = "failed";
  some[3].report = Json{{"views", 3}};
  some[4].figures.within = std::nullopt;
  const StressSummary s = summarize(p, some);
  const ScratchFolder folder;
  write_stress_results(folder / "results.json", p, s);
  const auto back = read_stress_results(folder / "results.json");
  ASSERT_EQ(back.size(), some.size());
  for (std::size_t i = 0; i < back.size(); ++i) EXPECT_EQ(back[i].to_json(), some[i].to_json());
  EXPECT_TRUE(back[3].figures.failed);

  Progress silent;
  const auto files = write_stress_page(folder / ".", p, s, silent);
  EXPECT_THAT(files, testing::Contains("stress--images.png"));
  EXPECT_THAT(files, testing::Contains("stress--marks.svg"));
  const std::string md = read_text(folder / "summary.md");
  EXPECT_THAT(md, HasSubstr("| up to 1 | v | 97.5 | 95.0 | b at 1 | pass |"));
  EXPECT_THAT(md, HasSubstr("| up to 2 | v | 91.5 | 88.0 | b at 2 | short by 2.0 |"));
  EXPECT_THAT(md, HasSubstr("| kind clutter | v | 0 of 1 |"));
  EXPECT_THAT(md, HasSubstr("| noise |  | v | 90.0 | 2.07 |"));
  const std::string page = read_text(folder / "index.html");
  EXPECT_THAT(page, HasSubstr("Test &lt;plan&gt;"));
  EXPECT_THAT(page, HasSubstr("<tr class=failed>"));
  const std::string svg = read_text(folder / "stress--images.svg");
  EXPECT_THAT(svg, HasSubstr(">noise</text>"));
  EXPECT_THAT(svg, HasSubstr(">2.07</text>"));
}

}  // namespace
}  // namespace photohull::chart
