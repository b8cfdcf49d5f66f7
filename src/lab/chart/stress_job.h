// `photohull stress`: degrades scenes step by step and measures what becomes of their meshes.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/describe.h"
#include "core/progress.h"
#include "lab/chart/result_store.h"
#include "lab/chart/stress_plan.h"
#include "lab/chart/stress_summary.h"

namespace photohull::chart {

struct StressOptions {
  std::filesystem::path plan;    ///< exists
  std::filesystem::path output;  ///< made when it does not exist
  /// Folder of an earlier run, whose curves are drawn beside these; empty: none.
  std::filesystem::path before;
  std::filesystem::path program;  ///< synthesizes, reconstructs and evaluates
  NormalizeSpec normalize;        ///< how specs are checked and compared
  StressSelection selection;
  bool force = false;      ///< repeat runs that are there
  bool retry = false;      ///< repeat runs that failed
  bool draw_only = false;  ///< no runs: draw results.json again
};

/// Without the plan, the output and the program.
void describe(Described& to, StressOptions& options);

struct StressOutcome {
  int made = 0, reused = 0;
  int failed = 0;  ///< of all: the reconstruction ended with an error or by its own verdict
  StressSummary summary;
  std::vector<std::string> files;  ///< in the output folder, the page first
};

/// A plan and what is left to do of it. Runs that are the same on several axes, above all the clean
/// ones, are made once. A run is done when its record is there for the same spec, arguments and
/// program (by content). Scenes are made when one of their runs is to be made, and removed after.
class StressJob {
 public:
  struct Run {
    std::string id;
    std::string label;  ///< of its first sample: "bowl: pose-error 2: default"
    Json spec;
    std::string spec_hash;
    std::vector<std::string> arguments;
    std::optional<StressRecord> record;  ///< of runs that are done
  };

  /// Reads the plan, checks all specs and finds what was done before; writes nothing. Throws Error
  /// and UsageError.
  explicit StressJob(StressOptions options);

  const StressPlan& plan() const { return plan_; }
  const std::vector<Run>& runs() const { return runs_; }
  /// Records that could not be used, and why.
  const std::vector<std::string>& warnings() const { return warnings_; }
  double total_weight() const;

  /// Does what is left and writes results.json. Every run that finished is kept, whatever happens
  /// after it. Throws Cancelled, and Error when a scene cannot be made or DIR not be written.
  StressOutcome run(Progress& progress);
  /// Draws what run() gave, and adds the names of the files to it.
  void draw(StressOutcome& outcome, Progress& progress) const;

 private:
  struct Place {
    StressSample sample;  ///< without its figures
    std::size_t run = 0;
  };
  void plan_runs();
  void add_samples(const StressAxis& axis, const StressPoint& point, bool clean, int repeat);
  std::size_t run_of(const Json& spec, const std::vector<std::string>& arguments, int repeat,
                     const std::string& label);
  void find_done(Run& run);
  std::vector<std::vector<std::size_t>> runs_by_scene() const;
  void make_scene(const Run& run, const std::filesystem::path& folder, const Progress& progress);
  StressRecord execute(const Run& run, const std::filesystem::path& scene,
                       const Progress& progress) const;
  void make_runs(Progress& progress, StressOutcome& outcome);
  std::vector<StressSample> samples() const;

  StressOptions options_;
  StressPlan plan_;
  ResultStore store_;
  std::string program_hash_;
  std::vector<Run> runs_;
  std::map<std::string, std::size_t> run_at_;  ///< by id
  std::vector<Place> places_;
  std::vector<std::string> warnings_;
};

}  // namespace photohull::chart
