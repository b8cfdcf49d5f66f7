// plan, run, status, merge and submit, from the command line; with the engines that are there.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <atomic>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <future>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "batch_scenes.h"
#include "core/child_process.h"
#include "support/places.h"

namespace photohull::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class PlanCommand : public BatchScenes {
 protected:
  static constexpr int kPieces = 4;

  void plan(const std::string& to, int count = kPieces) const {
    succeed(command("plan", list_of(count), to));
  }
  json status(const std::string& job) const {
    return json::parse(succeed({"status", path(job), "--json"}).out);
  }
  /// The files of an undisturbed batch.
  std::map<std::string, std::string> calm() const {
    succeed(batch(list_of(kPieces), "calm"));
    return results("calm", kPieces);
  }
  void submit_and_compare(const std::string& engine, const Arguments& before,
                          int workers = 3) const;
};

std::string command_line_of(const fs::path& process) {
  std::ifstream file(process / "cmdline");
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Kills the first process that it finds at work in the folder; null where there is none.
bool kill_a_worker(const std::string& job) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator("/proc", ignored)) {
    const std::string name = entry.path().filename();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string line = command_line_of(entry.path());
    const std::string run = std::string("\0run\0", 5) + job;
    if (line.find("photohull-main") == std::string::npos &&
        line.find("photohull" + run) == std::string::npos)
      continue;
    if (line.find(run) == std::string::npos) continue;
    return ::kill(std::stoi(name), SIGKILL) == 0;
  }
  return false;
}

void PlanCommand::submit_and_compare(const std::string& engine, const Arguments& before,
                                     int workers) const {
  plan("job");
  Arguments words = before;
  for (const std::string& word : Arguments{test::program(), "submit", path("job"), "--with", engine,
                                           "--workers", concat(workers)})
    words.push_back(word);
  std::atomic<bool> ended = false;
  std::atomic<int> killed = 0;
  std::thread killer([&] {  // one worker, a moment after it began
    while (!ended && killed == 0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      if (fs::exists(folder_ / "job/.photohull-batch/s0/lock"))
        killed += kill_a_worker(path("job"));
    }
  });
  const Finished run = run_program(
      words, {.environment = {"OMPI_ALLOW_RUN_AS_ROOT=1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                              "OMPI_MCA_rmaps_base_oversubscribe=1"},
              .timeout_seconds = 300});
  ended = true;
  killer.join();
  if (run.code == 77) GTEST_SKIP() << run.err;
  EXPECT_EQ(run.code, 0) << run.out << run.err;
  EXPECT_EQ(killed, 1);
  EXPECT_EQ(status("job")["complete"], true);
  EXPECT_THAT(table("job"),
              AllOf(HasSubstr("\ns0,"), HasSubstr("\ns3,"), Not(HasSubstr("not made"))));
  EXPECT_EQ(results("job", kPieces), calm());
}

TEST_F(PlanCommand, RunMakesWhatWasPlanned) {
  const Finished planned = succeed(command("plan", list_of(kPieces), "job"));
  EXPECT_THAT(planned.out, AllOf(HasSubstr("4 scenes to make"), HasSubstr("photohull run ")));
  EXPECT_FALSE(fs::exists(folder_ / "job/s0"));
  EXPECT_EQ(status("job")["waiting"].size(), 4u);
  const Finished early = run_photohull({"merge", path("job")});
  EXPECT_EQ(early.code, 1);
  EXPECT_THAT(early.err,
              HasSubstr("4 of 4 scenes are not made yet, the first is s0; 'photohull run "));

  succeed({"run", path("job"), "--pieces", "2-3"});
  EXPECT_EQ(status("job")["waiting"], json({"s0", "s3"}));
  EXPECT_THAT(succeed({"run", path("job"), "--next"}).out, HasSubstr("0 of them made before"));
  EXPECT_EQ(status("job")["waiting"], json({"s3"}));
  EXPECT_EQ(status("job")["complete"], false);
  EXPECT_THAT(succeed({"run", path("job")}).out, HasSubstr("4 scenes, 3 of them made before"));
  EXPECT_THAT(succeed({"status", path("job")}).out, HasSubstr("made, good     4: s0, s1, s2, s3"));
  EXPECT_THAT(succeed({"merge", path("job")}).out, HasSubstr("verdict good: 4"));
  EXPECT_EQ(results("job", kPieces), calm());
  // What batch made is kept, for it is the same plan.
  EXPECT_THAT(succeed({"run", path("calm")}).out, HasSubstr("4 of them made before"));
}

TEST_F(PlanCommand, RunTrustsWhatWasMadeForItsPlan) {
  plan("job", 1);
  succeed({"run", path("job")});
  write_masks("cutouts", 254, 0);  // other files
  EXPECT_THAT(succeed({"run", path("job")}).out, HasSubstr("1 of them made before"));
  plan("job", 1);
  EXPECT_THAT(succeed({"run", path("job")}).out, HasSubstr("0 of them made before"));
  plan("job", 1);  // nothing has changed
  EXPECT_THAT(succeed({"run", path("job")}).out, HasSubstr("1 of them made before"));
}

TEST_F(PlanCommand, PathsOfThePlanBeginWhereItWasMade) {
  const RunOptions here{.working_folder = folder_.string()};
  const std::string scene_word = fs::path(scene()).lexically_relative(folder_);
  const Finished planned =
      run_photohull({"plan", scene_word, "--masks", "cutouts", "--method", "hull", "--resolution",
                     "20", "--report-page", "off", "--out", "job"},
                    here);
  ASSERT_EQ(planned.code, 0) << planned.err;
  succeed({"run", path("job")});
  EXPECT_EQ(status("job")["complete"], true);
}

TEST_F(PlanCommand, StatusTellsWhatFailedAndWhatIsAtWork) {
  plan("job", 3);
  fs::remove(folder_ / "job/.photohull-batch/.plan.json");
  fail(1, {"status", path("job")}, {"job", "no batch was planned", "photohull plan"});
  write_masks("nothing", 0, 0);
  const std::string list =
      list_of(2) + concat("\"", scene(), "\" --name bad --masks \"", path("nothing"), "\"\n");
  succeed(command("plan", list, "job"));
  EXPECT_EQ(run_photohull({"run", path("job"), "--pieces", "3"}).code, 1);
  const json found = status("job");
  EXPECT_THAT(std::string(found["failed"]["bad"]), HasSubstr("mask"));
  EXPECT_EQ(found["pieces"], 3);
  EXPECT_THAT(succeed({"status", path("job")}).out, HasSubstr("no result      bad: "));
  write_bytes(folder_ / "job/.photohull-batch/.plan.json", "{}");
  for (const char* command : {"run", "status", "merge"})
    fail(1, {command, path("job")}, {".plan.json", "not a plan", "make it anew"});
}

TEST_F(PlanCommand, FaultsAreToldBeforeTheWork) {
  plan("job", 2);
  fail(2, {"run", path("job"), "--pieces", "3"}, {"--pieces 3", "between 1 and 2"});
  fail(2, {"run", path("job"), "--pieces", "1", "--next"}, {"--next"});
  fail(1, {"run", path("nowhere")}, {"nowhere", "no batch was planned"});
  EXPECT_FALSE(fs::exists(folder_ / "nowhere"));
  fail(1, {"submit", path("nowhere")}, {"nowhere", "no batch was planned"});
  fail(2, {"submit", path("job"), "--with", "cloud"}, {"--with", "slurm"});
  const Finished bare =
      run_photohull({"submit", path("job"), "--with", "slurm"}, {.environment = {"PATH=/nowhere"}});
  EXPECT_EQ(bare.code, 1);
  EXPECT_THAT(bare.err, AllOf(HasSubstr("needs the program 'sbatch'"), HasSubstr("PATH")));
  const Finished dry = succeed({"submit", path("job"), "--with", "slurm", "--dry-run"});
  EXPECT_THAT(dry.out, AllOf(HasSubstr("sbatch"), HasSubstr("--array=1-2"), HasSubstr("merge")));
  EXPECT_FALSE(fs::exists(folder_ / "job/submit.sh"));
}

/// One scene whose surface several processes match.
class TilesOfAPlan : public PlanCommand {
 protected:
  static constexpr int kProcesses = 3;

  void plan_tiles() const {
    fs::remove_all(folder_ / "job");
    succeed({"plan", scene(), "--masks", path("cutouts"), "--resolution", "64", "--tiles", "12",
             "--report-page", "off", "--out", path("job")});
  }
  /// What the processes said; `work` goes on meanwhile.
  std::string run_together(const std::function<void()>& work = [] {}) const {
    std::vector<std::future<Finished>> running;
    for (int i = 0; i < kProcesses; ++i)
      running.push_back(std::async(std::launch::async, [this] {
        return run_program({test::program(), "run", path("job"), "--threads", "1"});
      }));
    work();
    std::string said;
    for (auto& process : running) said += process.get().err;
    return said;
  }
  std::map<std::string, std::string> files(const fs::path& results) const {
    std::map<std::string, std::string> out;
    for (const char* name : {"mesh.ply", "preview.png"}) out[name] = read_bytes(results / name);
    return out;
  }
  std::map<std::string, std::string> alone() const {
    succeed({"reconstruct", scene(), "--masks", path("cutouts"), "--resolution", "64",
             "--report-page", "off", "--out", path("alone")});
    return files(folder_ / "alone");
  }
  fs::path kept() const { return folder_ / "job/.photohull-batch" / folder_.filename(); }
  fs::path results() const { return folder_ / "job" / folder_.filename(); }
};

TEST_F(TilesOfAPlan, ProcessesWithoutASceneMatchThoseOfAnother) {
  const auto expected = alone();
  std::string said;
  for (int i = 0; i < 5 && said.find("helping others") == std::string::npos; ++i) {
    plan_tiles();  // again where the first process was done before the others had begun
    said = run_together();
    EXPECT_EQ(files(results()), expected);
  }
  EXPECT_THAT(said, HasSubstr("helping others with their tiles"));
  EXPECT_EQ(status("job")["complete"], true);
  EXPECT_FALSE(fs::exists(kept() / "tiles")) << "files are left";
}

TEST_F(TilesOfAPlan, AProcessThatIsKilledChangesNothing) {
  const auto expected = alone();
  plan_tiles();
  int killed = 0;
  run_together([&] {
    for (int i = 0; i < 1000 && killed == 0; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      if (fs::exists(kept() / "tiles")) killed += kill_a_worker(path("job"));
    }
  });
  EXPECT_EQ(killed, 1);
  succeed({"run", path("job")});  // the one that had the scene may have been the one
  EXPECT_EQ(files(results()), expected);
  EXPECT_FALSE(fs::exists(kept() / "tiles")) << "files are left";
}

TEST_F(TilesOfAPlan, AFolderForTilesThatCannotBeMadeIsAnError) {
  const auto expected = alone();
  plan_tiles();
  fs::create_directories(kept());
  write_bytes(kept() / "tiles", "no folder");
  const Finished without = run_photohull({"run", path("job")});
  EXPECT_EQ(without.code, 1);
  EXPECT_THAT(without.err, HasSubstr("tiles cannot be made"));
  fs::remove(kept() / "tiles");
  succeed({"run", path("job"), "--retry"});
  EXPECT_EQ(files(results()), expected);
}

TEST_F(PlanCommand, LocalProcessesMakeItThoughOneIsKilled) { submit_and_compare("local", {}); }

TEST_F(PlanCommand, OneMoreProcessMakesWhatTheOnlyOneLeft) { submit_and_compare("local", {}, 1); }

TEST_F(PlanCommand, ParallelMakesItThoughOneIsKilled) {
  if (!is_on_path("parallel")) GTEST_SKIP() << "GNU parallel is not installed";
  submit_and_compare("parallel", {});
}

TEST_F(PlanCommand, MpiMakesItThoughOneIsKilled) {
  if (!is_on_path("mpirun")) GTEST_SKIP() << "mpirun is not installed";
  submit_and_compare("mpi", {});
}

TEST_F(PlanCommand, SlurmMakesItThoughOneIsKilled) {
  submit_and_compare("slurm", {test::in_checkout("tests/cli/with_slurm.sh"), path("slurm")});
}

}  // namespace
}  // namespace photohull::test
