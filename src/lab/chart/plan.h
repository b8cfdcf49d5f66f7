// What a chart is to compare: a JSON file (docs/guide/charts.md).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace photohull::chart {

struct PlanScene {
  std::string name;            ///< unique in the plan; letters, digits and "._-"
  std::filesystem::path path;  ///< a scene folder with truth, or a synthetic scene's spec
  bool synthetic = false;      ///< `path` is a spec
};

/// One option set of `photohull reconstruct`, run at each of its resolutions.
struct Variant {
  std::string name;                    ///< unique in the plan
  std::vector<std::string> arguments;  ///< after SCENE and --out
  std::vector<int> resolutions;        ///< --resolution; empty: one run without it
};

/// Figures of other programs (external.h).
struct ExternalSource {
  std::filesystem::path path;
  bool optional = false;
};

struct Plan {
  std::filesystem::path file;
  std::string title;
  std::vector<PlanScene> scenes;  ///< those that exist
  std::vector<Variant> variants;
  std::vector<ExternalSource> external;
  std::vector<std::string> mean_over;  ///< scenes of the mean charts; empty: all
  std::vector<std::string> notes;      ///< optional scenes that are absent
  int repeats = 1;                     ///< reconstructions a run; 1 to 99
  double time_limit_seconds = 3600;    ///< a reconstruction; 0.1 to 1e6
  double threshold_percent = 0.25;     ///< of the F-score, in percent of the truth's diagonal
  bool keep = false;                   ///< keep the meshes
};

/// Reads a plan. Paths in it are relative to its own folder. Throws Error that names the file and
/// the JSON path for unknown fields, wrong types, missing scenes, equal names, and a plan without
/// any run.
Plan read_plan(const std::filesystem::path& file);

}  // namespace photohull::chart
