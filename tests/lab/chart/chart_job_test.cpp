#include "lab/chart/chart_job.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <thread>

#include "fake_program.h"
#include "lab/chart/results_file.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;
using test::error_of;
using test::FakeWorld;
using test::Listener;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Optional;

constexpr const char* kFourRuns = R"({"scenes": ["ball", "cube"], "methods": ["hull"],
                                      "resolutions": [50, 100]})";

std::vector<fs::path> run_files(const FakeWorld& world) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(world.out() / "runs"))
    files.push_back(entry.path());
  return files;
}

TEST(ChartJob, RunsEverySceneAndResolutionOnce) {
  FakeWorld world({"ball", "cube"});
  world.plan(kFourRuns);
  const ChartSummary summary = world.run();
  EXPECT_EQ(summary.made, 4);
  EXPECT_EQ(summary.failed, 0);
  EXPECT_EQ(world.calls("reconstruct"), 4);
  EXPECT_EQ(world.calls("evaluate"), 4);
  EXPECT_EQ(run_files(world).size(), 4u);
  ASSERT_EQ(summary.outcomes.size(), 4u);
  EXPECT_EQ(summary.outcomes[1].label(), "hull 100");
  EXPECT_THAT(summary.outcomes[1].figures.f_at(0.25), Optional(testing::DoubleNear(80, 1e-6)));
  EXPECT_GT(summary.outcomes[0].cpu_seconds, 0);
  EXPECT_GT(summary.outcomes[0].peak_mb, 0);
  EXPECT_TRUE(fs::is_empty(world.out() / "work"));
  EXPECT_FALSE(fs::exists(world.out() / "meshes"));
}

TEST(ChartJob, SkipsWhatIsDoneAndMakesWhatIsNew) {
  FakeWorld world({"ball", "cube"});
  world.plan(kFourRuns);
  world.run();
  world.forget_calls();
  EXPECT_EQ(world.run().reused, 4);
  EXPECT_EQ(world.calls("reconstruct"), 0);
  world.plan(R"({"scenes": ["ball", "cube"], "methods": ["hull"], "resolutions": [50, 100, 200]})");
  const ChartSummary summary = world.run();
  EXPECT_EQ(summary.made, 2);
  EXPECT_EQ(summary.reused, 4);
  EXPECT_EQ(world.calls("reconstruct"), 2);
}

TEST(ChartJob, RunsAgainWhenTheSceneChanges) {
  FakeWorld world({"ball", "cube"});
  world.plan(kFourRuns);
  world.run();
  write_text(world / "cube/gt.ply", "another truth");
  EXPECT_EQ(world.run().made, 2);
  write_text(world / "ball/extra.txt", "one more file");
  EXPECT_EQ(world.run().made, 2);
}

TEST(ChartJob, RunsAgainWhenTheProgramOrTheArgumentsChange) {
  FakeWorld world({"ball", "cube"});
  world.plan(kFourRuns);
  world.run();
  write_text(world.program(), read_text(world.program()) + "\n# another version\n");
  EXPECT_EQ(world.run().made, 4);
  world.plan(R"({"scenes": ["ball", "cube"], "methods": ["hull"], "resolutions": [50, 100],
                 "arguments": ["--views", "0-9"]})");
  EXPECT_EQ(world.run().made, 4);
}

TEST(ChartJob, ForceRunsEverythingAgain) {
  FakeWorld world({"ball", "cube"});
  world.plan(kFourRuns);
  world.run();
  ChartOptions options = world.options();
  options.force = true;
  EXPECT_EQ(world.run(options).made, 4);
}

TEST(ChartJob, RepeatsDamagedAndOlderRecordsWithAWarning) {
  FakeWorld world({"ball", "cube"});
  world.plan(kFourRuns);
  world.run();
  const auto files = run_files(world);
  write_text(files[0], read_text(files[0]).substr(0, 100));
  std::string older = read_text(files[1]);
  older.replace(older.find("\"layout\": 1"), 11, "\"layout\": 0");
  write_text(files[1], older);
  const ChartJob job(world.options());
  EXPECT_THAT(job.warnings(),
              testing::UnorderedElementsAre(
                  testing::AllOf(HasSubstr(files[0].string()), HasSubstr("repeated")),
                  testing::AllOf(HasSubstr(files[1].string()), HasSubstr("another version"))));
  EXPECT_EQ(world.run().made, 2);
}

TEST(ChartJob, PlanningWritesNothing) {
  const FakeWorld world({"ball", "cube"});
  world.plan(kFourRuns);
  const ChartJob job(world.options());
  EXPECT_EQ(job.runs().size(), 4u);
  EXPECT_FALSE(job.runs()[0].record);
  EXPECT_THAT(job.runs()[1].planned.arguments,
              ElementsAre("--method", "hull", "--resolution", "100"));
  EXPECT_FALSE(fs::exists(world.out()));
}

TEST(ChartJob, StagesAddUpToTheWeight) {
  const FakeWorld world;
  world.plan(R"({"scenes": ["ball"], "methods": ["hull"], "resolutions": [50, 100]})");
  ChartJob job(world.options());
  const double weight = job.total_weight();
  Listener listener;
  ChartSummary summary = job.run(listener);
  job.draw(summary, listener);
  EXPECT_DOUBLE_EQ(listener.weight, weight);
  EXPECT_EQ(listener.stages[0], "run 1 of 2: ball: hull 50");
}

TEST(ChartJob, KeepsFailedRunsAndGoesOn) {
  FakeWorld world;
  world.plan(R"({"scenes": ["ball"], "methods": ["hull"], "resolutions": [50],
                 "variants": [{"name": "broken", "arguments": ["--fail"]},
                              {"name": "crashing", "arguments": ["--crash"]},
                              {"name": "mute", "arguments": ["--mute"]}]})");
  Listener listener;
  ChartSummary summary;
  {
    ChartJob job(world.options());
    summary = job.run(listener);
    job.draw(summary, listener);
  }
  EXPECT_EQ(summary.made, 4);
  EXPECT_EQ(summary.failed, 3);
  EXPECT_EQ(listener.warnings.size(), 3u);
  ASSERT_EQ(summary.outcomes.size(), 4u);
  EXPECT_FALSE(summary.outcomes[0].failed);
  EXPECT_EQ(summary.outcomes[1].failure, "reconstruct: exit code 3: photohull: no such luck");
  EXPECT_EQ(summary.outcomes[2].failure, "reconstruct: ended by signal 11");
  EXPECT_THAT(summary.outcomes[3].failure, HasSubstr("printed no report"));
  const std::string page = read_text(world.out() / "index.html");
  EXPECT_THAT(page, HasSubstr("FAILED: reconstruct: exit code 3: photohull: no such luck"));
  EXPECT_THAT(read_text(world.out() / "speed-accuracy--ball.svg"), HasSubstr("broken 50 failed"));
  EXPECT_EQ(world.run().made, 0) << "failures are results too";
  ChartOptions options = world.options();
  options.retry = true;
  EXPECT_EQ(world.run(options).made, 3);
}

TEST(ChartJob, DrawsFailuresOnly) {
  FakeWorld world;
  world.plan(R"({"scenes": ["ball"], "variants": [{"name": "broken", "arguments": ["--fail"]}]})");
  const ChartSummary summary = world.run_and_draw(world.options());
  EXPECT_EQ(summary.failed, 1);
  EXPECT_THAT(read_text(world.out() / "index.html"), HasSubstr("no such luck"));
  EXPECT_THAT(read_text(world.out() / "speed-accuracy--ball.svg"), HasSubstr("broken failed"));
}

TEST(ChartJob, KillsAtTheTimeLimitAndTriesAgainWithMoreTime) {
  FakeWorld world;
  const std::string head =
      R"({"scenes": ["ball"], "variants": [{"name": "slow", "arguments": ["--sleep"]}],
          "time_limit_seconds": )";
  world.plan(head + "0.2}");
  const ChartSummary summary = world.run();
  EXPECT_EQ(summary.outcomes.at(0).failure, "reconstruct: killed at the time limit");
  EXPECT_GE(summary.outcomes.at(0).wall_seconds, 0.2);
  EXPECT_EQ(world.run().made, 0);
  world.plan(head + "0.3}");
  EXPECT_EQ(world.run().made, 1);
  world.plan(head + "0.1}");
  EXPECT_EQ(world.run().made, 0);
}

TEST(ChartJob, TakesTheMedianOfRepeats) {
  FakeWorld world;
  world.plan(R"({"scenes": ["ball"], "methods": ["hull"], "repeats": 3})");
  world.run();
  EXPECT_EQ(world.calls("reconstruct"), 3);
  EXPECT_EQ(world.calls("evaluate"), 1);
  const auto records = read_results(world.out() / "results.json");
  ASSERT_EQ(records.size(), 1u);
  ASSERT_EQ(records[0].repeats.size(), 3u);
  const double median = records[0].repeats[records[0].median].cpu_seconds;
  int below = 0, above = 0;
  for (const Timing& t : records[0].repeats) {
    below += t.cpu_seconds < median;
    above += t.cpu_seconds > median;
  }
  EXPECT_LE(below, 1);
  EXPECT_LE(above, 1);
}

TEST(ChartJob, KeepsMeshesWhenAskedTo) {
  FakeWorld world;
  const std::string head = R"({"scenes": ["ball"], "methods": ["hull"], "keep": )";
  world.plan(head + "false}");
  world.run();
  world.plan(head + "true}");
  EXPECT_EQ(world.run().made, 1) << "the mesh of the earlier run is gone";
  const auto records = read_results(world.out() / "results.json");
  EXPECT_EQ(read_text(world.out() / records.at(0).mesh), "hull 100\n");
  EXPECT_EQ(world.run().made, 0);
}

TEST(ChartJob, MakesSyntheticScenesOnce) {
  FakeWorld world;
  write_text(world / "cup.json", R"({"texture": "wood.txt"})");
  write_text(world / "wood.txt", "brown");
  world.plan(R"({"scenes": ["cup.json"], "methods": ["hull"]})");
  EXPECT_EQ(world.run().made, 1);
  EXPECT_TRUE(fs::exists(world.out() / "scenes/cup/gt.ply"));
  EXPECT_EQ(world.run().made, 0);
  EXPECT_EQ(world.calls("synthesize"), 1);
  write_text(world / "wood.txt", "dark brown");  // a file that the spec names
  world.run();
  EXPECT_EQ(world.calls("synthesize"), 2);
  write_text(world / "cup.json", R"({"texture": "wood.txt", "views": 9})");
  EXPECT_EQ(world.run().made, 1);
  EXPECT_EQ(world.calls("synthesize"), 3);
}

TEST(ChartJob, CancellationKeepsFinishedRuns) {
  FakeWorld world;
  world.plan(R"({"scenes": ["ball"], "methods": ["hull"],
                 "variants": [{"name": "slow", "arguments": ["--sleep"]}]})");
  struct CancelLater : Progress {
    void stage(const std::string& name, double) override {
      if (name.find("slow") != std::string::npos) process_cancellation().cancel();
    }
  } progress;
  process_cancellation().reset();
  EXPECT_THROW(ChartJob(world.options()).run(progress), Cancelled);
  process_cancellation().reset();
  EXPECT_EQ(run_files(world).size(), 1u);
  EXPECT_EQ(read_results(world.out() / "results.json").size(), 1u);
  EXPECT_TRUE(fs::is_empty(world.out() / "work"));
  world.plan(R"({"scenes": ["ball"], "methods": ["hull"]})");
  EXPECT_EQ(world.run().made, 0);
}

TEST(ChartJob, DrawsAgainFromResults) {
  FakeWorld world;
  world.plan(R"({"scenes": ["ball"], "methods": ["hull"], "resolutions": [50, 100]})");
  EXPECT_THAT(error_of([&] {
                ChartOptions options = world.options();
                options.draw_only = true;
                world.run(options);
              }),
              HasSubstr("no results to draw"));
  world.run();
  world.forget_calls();
  write_text(world / "peers.json",
             R"([{"scene": "ball", "tool": "other", "cpu_s": 5, "f025": 91}])");
  world.plan(R"({"scenes": ["ball"], "methods": ["hull"], "external": ["peers.json"]})");
  ChartOptions options = world.options();
  options.draw_only = true;
  const ChartSummary summary = world.run_and_draw(options);
  EXPECT_EQ(world.calls("reconstruct"), 0);
  EXPECT_EQ(summary.outcomes.size(), 3u);
  EXPECT_THAT(read_text(world.out() / "index.html"), HasSubstr("other"));
}

TEST(ChartJob, ResultsTellFrontsAndExponents) {
  FakeWorld world({"ball", "cube"});
  world.plan(R"({"scenes": ["ball", "cube"], "methods": ["hull"], "resolutions": [50, 100, 200]})");
  world.run();
  const Json results = read_json(world.out() / "results.json");
  ASSERT_EQ(results["groups"].size(), 3u);
  EXPECT_EQ(results["groups"][0]["scene"], "mean");
  EXPECT_FALSE(results["groups"][1]["pareto_front"].empty());
  // The program's error is 10 / resolution.
  EXPECT_NEAR(results["groups"][1]["fits"][0]["error_exponent"].get<double>(), -1, 1e-6);
}

TEST(ChartJob, RefusesAFolderThatTakesNoFiles) {
  FakeWorld world;
  world.plan(R"({"scenes": ["ball"], "methods": ["hull"]})");
  write_text(world.out(), "a file");
  EXPECT_THAT(error_of([&] { world.run(); }),
              testing::AllOf(HasSubstr(world.out().string()), HasSubstr("--out")));
}

TEST(ChartJob, RefusesAFolderThatIsInUse) {
  FakeWorld world;
  world.plan(R"({"scenes": ["ball"], "methods": ["hull"]})");
  ResultStore other(world.out());
  other.open();
  EXPECT_THAT(error_of([&] { world.run(); }), HasSubstr("another photohull is at work"));
}

}  // namespace
}  // namespace photohull::chart
