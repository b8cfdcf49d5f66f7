#include "fault_runs.h"

#include <climits>
#include <csignal>
#include <set>

#include "core/error.h"
#include "support/places.h"

namespace photohull::test {
namespace fs = std::filesystem;

namespace {

constexpr long kKill = -3;  // fault_shim.cpp

/// The program's surroundings where that call fails, and where the fault lasts those after it.
RunOptions failing(const Fault& fault, long number) {
  RunOptions options;
  const long last = fault.lasting ? LONG_MAX : number;
  options.environment = {concat("LD_PRELOAD=", PHOTOHULL_FAULT_SHIM),
                         concat("PHOTOHULL_FAULT=", fault.call, ":", fault.what, ":", number, ":",
                                last, ":", fault.folder)};
  return options;
}

/// Reports tell of time and memory, the others mark or keep what is not complete.
bool differs_rightly(const std::string& name) {
  return name == "report.json" || name == "report.html" || name == "INCOMPLETE" ||
         name == ".photohull-checkpoint";
}

}  // namespace

std::vector<long> spread(long last, int count) {
  std::set<long> numbers = {1, last};
  for (int i = 1; i + 1 < count; ++i) numbers.insert(1 + i * (last - 1) / (count - 1));
  return {numbers.begin(), numbers.end()};
}

Files contents(const std::string& folder) {
  Files files;
  for (const std::string& name : listing(folder)) {
    const fs::path file = fs::path(folder) / name;
    if (fs::is_regular_file(file)) files[name] = read_bytes(file);
  }
  return files;
}

Reference FaultScene::run_without(const Arguments& job, const Fault& fault) const {
  RunOptions options;
  options.environment = {concat("LD_PRELOAD=", PHOTOHULL_FAULT_SHIM),
                         concat("PHOTOHULL_FAULT=", fault.call, ":0:0:0:", fault.folder),
                         concat("PHOTOHULL_FAULT_COUNT=", path("calls"))};
  fs::remove_all(out());
  succeed(job, options);
  Reference found{contents(out()), std::atol(read_bytes(path("calls")).c_str())};
  fs::remove_all(out());
  EXPECT_GT(found.calls, 0) << fault.call << " is never called";
  return found;
}

Finished FaultScene::run_with(const Arguments& job, const Fault& fault, long number) const {
  return run_photohull(job, failing(fault, number));
}

void FaultScene::kill_at(const Arguments& job, const std::string& call, long number) const {
  Arguments command = {test::program()};
  command.insert(command.end(), job.begin(), job.end());
  EXPECT_EQ(run_program(command, failing({call, kKill, out()}, number)).signal, SIGKILL);
}

void FaultScene::expect_whole_files(const Files& right) const {
  for (const auto& [name, bytes] : contents(out())) {
    if (differs_rightly(name)) continue;
    const auto same = right.find(name);
    EXPECT_TRUE(same != right.end()) << name << " is left over";
    EXPECT_TRUE(same == right.end() || same->second == bytes) << name << " is torn";
  }
}

void FaultScene::expect_all_files(const Files& right) const {
  expect_whole_files(right);
  EXPECT_EQ(contents(out()).size(), right.size());
}

void FaultScene::expect_no_harm(const Arguments& job, const Fault& fault, int places) const {
  const Reference right = run_without(job, fault);
  int survived = 0;
  const std::vector<long> numbers = spread(right.calls, places);
  for (const long number : numbers) {
    SCOPED_TRACE(concat(fault.call, " ", number, " fails with ", fault.what));
    fs::remove_all(out());
    const Finished run = run_with(job, fault, number);
    if (run.code == 0) {
      expect_all_files(right.files);
      ++survived;
      continue;
    }
    EXPECT_EQ(run.code, 1) << run.err;
    const std::vector<std::string> lines = run.error_lines();
    ASSERT_FALSE(lines.empty());
    EXPECT_THAT(lines.back(), testing::StartsWith("photohull: "));
    EXPECT_THAT(lines.back(), testing::HasSubstr(fault.folder));
    expect_whole_files(right.files);
  }
  std::printf("%s: %zu of %ld calls of %s failed, %d times without harm\n", job.front().c_str(),
              numbers.size(), right.calls, fault.call.c_str(), survived);
}

}  // namespace photohull::test
