// `photohull chart`: runs a plan's reconstructions, collects their figures and draws them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/describe.h"
#include "core/progress.h"
#include "lab/chart/execute_run.h"
#include "lab/chart/outcome.h"
#include "lab/chart/plan.h"
#include "lab/chart/result_store.h"

namespace photohull::chart {

struct ChartOptions {
  std::filesystem::path plan;     ///< exists
  std::filesystem::path output;   ///< made when it does not exist
  std::filesystem::path program;  ///< reconstructs, evaluates and synthesizes
  bool force = false;             ///< repeat runs and scenes that are there
  bool retry = false;             ///< repeat runs that failed
  bool draw_only = false;         ///< no runs: draw results.json again
};

/// Without its paths.
void describe(Described& to, ChartOptions& options);

struct ChartSummary {
  int made = 0;                    ///< runs of this call
  int reused = 0;                  ///< runs that were there
  int failed = 0;                  ///< of all
  std::vector<Outcome> outcomes;   ///< of the plan's runs, then the external ones
  std::vector<std::string> files;  ///< in the output folder, the page first
};

/// A plan and what is left to do of it. A run is done when its record is there for the same scene
/// (by content), arguments, repeats and program (by content); a run that was killed at a time limit
/// below the plan's is not, nor is one without its mesh where the plan keeps meshes.
class ChartJob {
 public:
  struct Run {
    PlannedRun planned;
    std::size_t scene = 0;            ///< in the plan
    double weight = 1;                ///< expected share of the job
    std::optional<RunRecord> record;  ///< of runs that are done
  };

  /// Reads the plan, all external tables and what was done before; writes nothing. Throws Error
  /// for a bad plan or table.
  explicit ChartJob(ChartOptions options);

  const Plan& plan() const { return plan_; }
  const std::vector<Run>& runs() const { return runs_; }
  /// Records that could not be used, and why.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// Sum of the stages' weights that run() and draw() will report.
  double total_weight() const;

  /// Does what is left and writes results.json. Every run that finished is kept, whatever happens
  /// after it. Throws Cancelled, and Error when the output folder cannot be written.
  ChartSummary run(Progress& progress);
  /// Draws what run() gave, and adds the names of the files to it.
  void draw(ChartSummary& summary, Progress& progress) const;

 private:
  void plan_runs();
  void find_done(Run& run);
  bool is_usable(const RunRecord& record) const;
  std::filesystem::path scene_folder(const PlanScene& scene) const;
  void make_scenes(Progress& progress);
  void make_runs(Progress& progress, ChartSummary& summary);
  std::vector<RunRecord> records() const;
  std::vector<Outcome> collect(const std::vector<RunRecord>& records) const;

  ChartOptions options_;
  Plan plan_;
  ResultStore store_;
  std::string program_hash_;
  std::vector<std::string> scene_hashes_;  ///< empty for scenes that are not made yet
  std::vector<Run> runs_;
  std::vector<Outcome> external_;
  std::vector<std::string> warnings_;
};

}  // namespace photohull::chart
