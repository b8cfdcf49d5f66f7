#include "pipeline/view_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "io/natural_less.h"

namespace photohull::pipeline {

void sort_views_by_name(Scene& scene) {
  std::vector<std::size_t> order(scene.views.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return io::natural_less(scene.views[a].name, scene.views[b].name);
  });
  std::vector<SourceView> views;
  std::vector<int> now(order.size());
  for (const std::size_t i : order) {
    now[i] = int(views.size());
    views.push_back(std::move(scene.views[i]));
  }
  scene.views = std::move(views);
  for (SceneTrack& track : scene.tracks) {
    for (SceneTrack::Observation& o : track.observations) o.view = now[std::size_t(o.view)];
    std::sort(track.observations.begin(), track.observations.end(),
              [](const auto& a, const auto& b) { return a.view < b.view; });
  }
}

}  // namespace photohull::pipeline
