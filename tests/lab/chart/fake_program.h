// A script in the place of photohull, and plans that run it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "lab/chart/chart_job.h"
#include "support/scratch_folder.h"

namespace photohull::chart::test {

/// A folder with a program, scenes with truth and a place for plans and results. The program
/// understands reconstruct, evaluate and synthesize, notes each call, and gives figures that follow
/// from --method and --resolution: F = 100 - 2000 / resolution and an error of 10 / resolution, for
/// the method "hull"; half of what lacks for others. Arguments make it misbehave: "--crash" ends it
/// by a signal, "--fail" with code 3 and a reason, "--sleep" never.
class FakeWorld {
 public:
  explicit FakeWorld(const std::vector<std::string>& scenes = {"ball"});

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  std::filesystem::path program() const { return folder_ / "program.sh"; }
  std::filesystem::path out() const { return folder_ / "out"; }
  /// Writes plan.json.
  void plan(const std::string& json) const;
  ChartOptions options() const;
  ChartSummary run() const;
  ChartSummary run(const ChartOptions& options) const;
  ChartSummary run_and_draw(const ChartOptions& options) const;
  /// How often a command was called, since forget_calls().
  int calls(const std::string& command);
  void forget_calls();

 private:
  ScratchFolder folder_;
};

/// Collects what a job says.
class Listener : public Progress {
 public:
  void stage(const std::string& name, double weight) override;
  void warn(const std::string& message) override { warnings.push_back(message); }
  std::vector<std::string> stages, warnings;
  double weight = 0;
};

/// Message of the Error that f throws; empty when it throws none.
template <typename F>
std::string error_of(F&& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

}  // namespace photohull::chart::test
