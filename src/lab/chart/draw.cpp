#include "lab/chart/draw.h"

#include <algorithm>

#include "core/atomic_file.h"
#include "core/error.h"
#include "lab/chart/chart_files.h"
#include "lab/chart/chart_set.h"
#include "lab/chart/page.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;

/// Scenes of the plan, then those that only external tables know.
std::vector<std::string> scenes_of(const Plan& plan, const std::vector<Outcome>& outcomes) {
  std::vector<std::string> scenes;
  for (const PlanScene& s : plan.scenes) scenes.push_back(s.name);
  for (const Outcome& o : outcomes)
    if (!o.external && std::find(scenes.begin(), scenes.end(), o.scene) == scenes.end())
      scenes.push_back(o.scene);
  return scenes;
}

}  // namespace

std::vector<std::string> draw_charts(const Plan& plan, const std::vector<Outcome>& outcomes,
                                     const fs::path& folder, Progress& progress) {
  const std::vector<std::string> scenes = scenes_of(plan, outcomes);
  std::vector<Outcome> shown;
  std::copy_if(outcomes.begin(), outcomes.end(), std::back_inserter(shown), [&](const Outcome& o) {
    return std::find(scenes.begin(), scenes.end(), o.scene) != scenes.end();
  });
  const std::vector<Chart> charts =
      make_charts(shown, scenes, plan.mean_over, plan.threshold_percent);
  std::vector<std::string> files = write_chart_files(charts, folder, progress);
  files.insert(files.begin(), "index.html");
  write_atomically(folder / "index.html",
                   make_page(plan.title, plan.notes, charts, shown, plan.threshold_percent));
  remove_stale_charts(folder, files);
  return files;
}

}  // namespace photohull::chart
