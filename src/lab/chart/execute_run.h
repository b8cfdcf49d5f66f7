// One run: reconstructions in processes of their own, judged in another. Private to lab.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/progress.h"
#include "lab/chart/plan.h"
#include "lab/chart/result_store.h"

namespace photohull::chart {

struct PlannedRun {
  std::string id;  ///< empty while the synthetic scene is not made
  std::string scene, variant;
  std::optional<int> resolution;
  std::vector<std::string> arguments;  ///< the variant's, and --resolution

  std::string label() const;  ///< "bunny: hull 64"
};

/// Reconstructs `scene` as often as the plan says, evaluates the mesh of the median repeat, and
/// keeps it if asked to. What fails is told by the record; throws Cancelled, and Error where the
/// folder of results fails.
RunRecord execute_run(const std::filesystem::path& program, const std::filesystem::path& scene,
                      const PlannedRun& run, const Plan& plan, const ResultStore& store,
                      const Progress& progress);

/// Makes the synthetic scene of a spec in the store, if it is not there or is another spec's or
/// another program's. Throws Error with the program's own words when it cannot be made.
void make_scene(const std::filesystem::path& program, const std::string& program_hash,
                const PlanScene& scene, const ResultStore& store, const Progress& progress);
/// Is it there already?
bool scene_is_made(const std::string& program_hash, const PlanScene& scene,
                   const ResultStore& store);

}  // namespace photohull::chart
