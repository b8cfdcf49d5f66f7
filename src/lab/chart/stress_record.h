// What a stressed reconstruction came to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lab/chart/json_fields.h"

namespace photohull::chart {

/// One reconstruction and its judgement, as DIR/runs/ID.json keeps it.
struct StressRecord {
  static constexpr int kLayout = 1;

  std::string id;
  Json spec;                           ///< of the scene, as merged from the plan
  std::vector<std::string> arguments;  ///< of `photohull reconstruct`, after SCENE and --out DIR
  double time_limit_seconds = 0;
  int exit_code = -1, signal = 0;  ///< of `reconstruct`; exit code -1 after a signal
  bool timed_out = false;
  std::string message;  ///< why there is no mesh or no judgement; one line, or empty
  double cpu_seconds = 0, wall_seconds = 0;
  std::int64_t peak_memory_bytes = 0;
  std::string mesh_hash;  ///< of mesh.ply's bytes; empty where there is none
  Json report;            ///< report.json; null where there is none
  Json evaluation;        ///< of `photohull evaluate --json`; null where there is none

  Json to_json() const;
  /// Throws Error that says what is wrong: another layout, or a damaged record.
  static StressRecord from_json(const std::filesystem::path& file, const Json& json);
};

/// What one point of a curve is made of. Shares are 0 to 1.
struct StressFigures {
  std::optional<double> f025, f05;  ///< F-score at 0.25 and 0.5 % of the diagonal; 0 without a mesh
  std::optional<double> confidence;  ///< mean of what mesh.ply promises for surface that is seen
  std::optional<double> within;      ///< share of its vertices that are within a voxel of the truth
  std::string verdict;               ///< of the report: good, doubtful or failed; empty without

  /// Did the program itself say that it failed: by an error, or by its verdict?
  bool failed = false;
};

StressFigures figures_of(const StressRecord& record);

}  // namespace photohull::chart
