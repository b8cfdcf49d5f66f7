// What the charts draw: one point a run, from this program or another.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/chart/figures.h"
#include "lab/chart/run_record.h"

namespace photohull::chart {

struct StageTime {
  std::string name;
  double cpu_seconds = 0;
};

enum class TimeKind { kCpu, kWall };

struct Outcome {
  std::string scene;
  std::string variant;            ///< option set, or the external tool
  std::optional<int> resolution;  ///< as asked for; none for external tools
  bool external = false;
  bool failed = false;
  std::string failure;  ///< one line
  std::optional<double> cpu_seconds, wall_seconds, peak_mb;
  Figures figures;
  std::vector<StageTime> stages;
  // Means over scenes only:
  int scenes = 1;         ///< how many there are
  int covered = 1;        ///< how many of them this mean is over
  int failed_scenes = 0;  ///< of these; their F-score counts as 0

  /// "space-carving 256".
  std::string label() const;
  const std::optional<double>& seconds(TimeKind kind) const {
    return kind == TimeKind::kCpu ? cpu_seconds : wall_seconds;
  }
  /// Present, and nothing failed, in every scene.
  bool complete() const { return !failed && covered == scenes && failed_scenes == 0; }
};

Outcome outcome_of(const RunRecord& record);

/// The mean of each variant and resolution over `scenes`, in order of first appearance. F-scores of
/// failed runs count as 0; times, memory and distances are means of what there is. A mean in which
/// every run failed is itself failed.
std::vector<Outcome> means_over(const std::vector<Outcome>& outcomes,
                                const std::vector<std::string>& scenes);

/// Indices of those on the Pareto front of time and F-score, by rising time. Failed and
/// incomplete ones are not on it.
std::vector<std::size_t> front_of(const std::vector<Outcome>& outcomes, double threshold_percent,
                                  TimeKind kind = TimeKind::kCpu);

}  // namespace photohull::chart
