#include "chart/draw.h"

#include <algorithm>

#include "chart/chart_set.h"
#include "chart/page.h"
#include "chart/png.h"
#include "chart/svg_renderer.h"
#include "core/atomic_file.h"
#include "core/error.h"

namespace photohull::chart {
namespace {

namespace fs = std::filesystem;
constexpr int kPngScale = 2;

/// Scenes of the plan, then those that only external tables know.
std::vector<std::string> scenes_of(const Plan& plan, const std::vector<Outcome>& outcomes) {
  std::vector<std::string> scenes;
  for (const PlanScene& s : plan.scenes) scenes.push_back(s.name);
  for (const Outcome& o : outcomes)
    if (!o.external && std::find(scenes.begin(), scenes.end(), o.scene) == scenes.end())
      scenes.push_back(o.scene);
  return scenes;
}

void remove_stale(const fs::path& folder, const std::vector<std::string>& files) {
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    const bool chart =
        name.find("--") != std::string::npos && (name.ends_with(".svg") || name.ends_with(".png"));
    std::error_code ignored;
    if (chart && std::find(files.begin(), files.end(), name) == files.end())
      fs::remove(entry.path(), ignored);
  }
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
  SvgRenderer renderer;
  std::vector<std::string> files = {"index.html"};
  for (std::size_t i = 0; i < charts.size(); ++i) {
    progress.check_cancelled();
    progress.update(double(i) / double(charts.size()));
    const Chart& c = charts[i];
    const std::string svg = renderer.render(c.option, c.width, c.height);
    write_atomically(folder / (c.id + ".svg"), svg);
    write_png(svg, kPngScale * c.width, kPngScale * c.height, folder / (c.id + ".png"));
    files.push_back(c.id + ".svg");
    files.push_back(c.id + ".png");
  }
  write_atomically(folder / "index.html",
                   make_page(plan.title, plan.notes, charts, shown, plan.threshold_percent));
  remove_stale(folder, files);
  return files;
}

}  // namespace photohull::chart
