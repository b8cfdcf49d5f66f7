// A finished run, as DIR/runs/ID.json keeps it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lab/chart/json_fields.h"

namespace photohull::chart {

/// One reconstruction of a run.
struct Timing {
  double wall_seconds = 0;
  double cpu_seconds = 0;  ///< user + system, all threads
  std::int64_t peak_memory_bytes = 0;
};

struct Failure {
  std::string step;  ///< "reconstruct" or "evaluate"
  int exit_code = -1, signal = 0;
  bool timed_out = false;
  std::string standard_error;  ///< its last 4 KiB
  /// One line for people.
  std::string message() const;
};

struct RunRecord {
  static constexpr int kLayout = 1;

  std::string id, scene, variant;
  std::optional<int> resolution;
  std::vector<std::string> arguments;  ///< of `photohull reconstruct`, after SCENE and --out DIR
  double time_limit_seconds = 0;
  std::vector<Timing> repeats;  ///< at least one
  std::size_t median = 0;       ///< the repeat whose CPU time is the median; report is its own
  std::optional<Failure> failure;
  Json report;       ///< report.json; null after a failure of `reconstruct`
  Json evaluation;   ///< of `photohull evaluate --json`; null after a failure
  std::string mesh;  ///< kept mesh, relative to DIR; empty where none was to be kept

  Json to_json() const;
  /// Throws Error that says what is wrong: another layout, or a damaged record. `file` is for
  /// messages.
  static RunRecord from_json(const std::filesystem::path& file, const std::string& where,
                             const Json& json);
};

}  // namespace photohull::chart
