#include "lab/chart/stress_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fake_program.h"
#include "lab/chart/stress_report.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::FakeWorld;
using testing::DoubleNear;
using testing::HasSubstr;
using testing::Optional;

constexpr const char* kPlan = R"({"scenes": [{"name": "a"}, {"name": "b", "spec": {"x": 1}}],
  "arguments": ["--resolution", "100"],
  "axes": [{"name": "noise", "fields": ["noise"], "strengths": [1, 2]},
           {"name": "voxels", "argument": "--resolution", "clean": 100, "strengths": [80, 40]},
           {"name": "repeats", "same_mesh": true, "points": [{"label": "again"}]}]})";

StressOptions options(const FakeWorld& world) {
  StressOptions o;
  o.plan = world / "plan.json";
  o.output = world.out();
  o.program = world.program();
  return o;
}

StressOutcome run(const StressOptions& o) {
  Progress silent;
  return StressJob(o).run(silent);
}

TEST(StressJob, MakesEveryRunOnceAndEverySceneOnlyWhileItIsNeeded) {
  FakeWorld world;
  world.plan(kPlan);
  const StressOutcome o = run(options(world));
  // Clean, noise 1 and 2, 80 and 40 voxels, and the repetition, of two scenes.
  EXPECT_EQ(o.made, 12);
  EXPECT_EQ(world.calls("reconstruct"), 12);
  EXPECT_EQ(world.calls("synthesize"), 6);
  EXPECT_TRUE(fs::is_empty(world.out() / "work"));
  ASSERT_EQ(o.summary.curves.size(), 3u);
  const StressCurve& voxels = o.summary.curves[1];
  // The program's F is 1 - 20 / resolution: 0.8, 0.75, 0.5.
  EXPECT_THAT(voxels.points[1].kept025, Optional(DoubleNear(0.9375, 1e-6)));
  EXPECT_THAT(voxels.break025, Optional(DoubleNear(80 - 40 * 0.0375 / 0.3125, 1e-5)));
  EXPECT_EQ(o.summary.curves[2].points[1].other_mesh, 0);
  EXPECT_EQ(o.summary.samples.size(), 2u * (3 + 3 + 2));
  EXPECT_EQ(o.summary.samples[0].report["photohull"], "0");
}

TEST(StressJob, GoesOnWhereItWasStopped) {
  FakeWorld world;
  world.plan(kPlan);
  struct CancelLater : Progress {
    void stage(const std::string& name, double) override {
      if (name.starts_with("run 5 ")) process_cancellation().cancel();
    }
  } progress;
  process_cancellation().reset();
  EXPECT_THROW(StressJob(options(world)).run(progress), Cancelled);
  process_cancellation().reset();
  EXPECT_TRUE(fs::is_empty(world.out() / "work"));
  EXPECT_FALSE(read_stress_results(world.out() / "results.json").empty());
  world.forget_calls();
  const StressOutcome o = run(options(world));
  EXPECT_EQ(o.reused, 4);
  EXPECT_EQ(o.made, 8);
  EXPECT_EQ(world.calls("reconstruct"), 8);
  EXPECT_EQ(run(options(world)).made, 0);
}

TEST(StressJob, RunsAgainWhatChangedOrIsDamaged) {
  FakeWorld world;
  world.plan(kPlan);
  run(options(world));
  const fs::path one = fs::directory_iterator(world.out() / "runs")->path();
  write_text(one, read_text(one).substr(0, 50));
  {
    Progress silent;
    StressJob job(options(world));
    ASSERT_EQ(job.warnings().size(), 1u);
    EXPECT_THAT(job.warnings()[0], HasSubstr("the run is repeated"));
    EXPECT_EQ(job.run(silent).made, 1);
  }
  StressOptions force = options(world);
  force.force = true;
  EXPECT_EQ(run(force).made, 12);
  write_text(world.program(), read_text(world.program()) + "\n# another version\n");
  EXPECT_EQ(run(options(world)).made, 12);
}

TEST(StressJob, SpecsThatMeanTheSameAreMadeOnce) {
  FakeWorld world;
  world.plan(R"({"scenes": [{"name": "a"}],
                 "axes": [{"name": "noise", "fields": ["noise"], "clean": 0, "strengths": [1]},
                          {"name": "blur", "fields": ["blur"], "clean": 0, "strengths": [1]}]})");
  EXPECT_EQ(run(options(world)).made, 4);
  StressOptions o = options(world);
  o.output = world / "other";
  o.normalize = [](const std::string& text, const std::string&) {
    Json spec = Json::parse(text);
    for (const char* field : {"noise", "blur"})
      if (!spec.contains(field)) spec[field] = 0;
    return Json{{"noise", spec["noise"]}, {"blur", spec["blur"]}}.dump();
  };
  EXPECT_EQ(run(o).made, 3) << "both clean runs are one";
  o.normalize = [](const std::string&, const std::string& source) -> std::string {
    throw Error(source + ": no spec");
  };
  EXPECT_THAT(error_of([&] { run(o); }),
              testing::AllOf(HasSubstr("plan.json"), HasSubstr("a: clean"), HasSubstr("no spec")));
}

TEST(StressJob, FailuresAreResultsWithAnFScoreOfNothing) {
  FakeWorld world;
  world.plan(
      R"({"scenes": [{"name": "a"}], "time_limit_seconds": 5, "axes": [{"name": "x", "points": [
      {"label": "bad", "arguments": ["--fail"]}, {"label": "slow", "arguments": ["--sleep"]},
      {"label": "mute", "arguments": ["--mute"]}]}]})");
  const StressOutcome o = run(options(world));
  EXPECT_EQ(o.failed, 2);
  ASSERT_EQ(o.summary.samples.size(), 4u);
  EXPECT_EQ(o.summary.samples[1].exit_code, 3);
  EXPECT_THAT(o.summary.samples[1].message, HasSubstr("no such luck"));
  EXPECT_THAT(o.summary.samples[1].figures.f025, Optional(0.0));
  EXPECT_THAT(o.summary.samples[2].message, HasSubstr("killed at the time limit"));
  EXPECT_THAT(o.summary.samples[3].message, HasSubstr("left no mesh.ply"));
  EXPECT_EQ(run(options(world)).made, 0);
  StressOptions again = options(world);
  again.retry = true;
  EXPECT_EQ(run(again).made, 2);
}

TEST(StressJob, DrawsAgainAndBesideAnEarlierRun) {
  FakeWorld world;
  world.plan(kPlan);
  run(options(world));
  world.forget_calls();
  StressOptions o = options(world);
  o.draw_only = true;
  o.before = world.out();
  Progress silent;
  StressJob job(o);
  StressOutcome outcome = job.run(silent);
  job.draw(outcome, silent);
  EXPECT_EQ(world.calls("reconstruct"), 0);
  EXPECT_EQ(outcome.summary.curves.size(), 6u);
  EXPECT_EQ(outcome.files.front(), "index.html");
  EXPECT_THAT(read_text(world.out() / "index.html"), HasSubstr("before: default"));
  o.before = world / "nowhere";
  EXPECT_THAT(error_of([&] { run(o); }), HasSubstr("there are no results of 'photohull stress'"));
}

}  // namespace
}  // namespace photohull::chart
