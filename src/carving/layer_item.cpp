#include "carving/layer_item.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/grid.h"

namespace photohull::carving {

double sweep_cosine(const projtex::GridCamera& camera, const glm::dvec3& point,
                    const SweepDirection& direction) {
  const glm::dvec3 ray = point - camera.centre;
  return ray[direction.axis] * direction.sign / std::max(glm::length(ray), 1e-9);
}

LayerItem layer_item(const glm::ivec3& brick, const SweepDirection& direction,
                     std::span<const projtex::GridCamera> cameras) {
  const glm::dvec3 centre = glm::dvec3(brick * kBrickEdge) + 0.5 * (kBrickEdge - 1);
  std::vector<std::pair<double, std::uint32_t>> ranked;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const auto& camera = cameras[i];
    const double frontal = sweep_cosine(camera, centre, direction);
    const glm::dvec3 p = camera.projection * glm::dvec4(centre, 1);
    if (frontal <= kLeastSweepCosine || p.z <= kBrickEdge) continue;
    const glm::dvec2 pixel(p.x / p.z, p.y / p.z);
    const double reach = kBrickEdge * camera.focal / p.z;
    if (pixel.x < -reach || pixel.y < -reach || pixel.x > camera.width + reach ||
        pixel.y > camera.height + reach)
      continue;
    ranked.emplace_back(-frontal, std::uint32_t(i));
  }
  std::sort(ranked.begin(), ranked.end());
  ranked.resize(std::min<std::size_t>(ranked.size(), LayerItem::kMostViews));
  LayerItem item{brick, int(ranked.size())};
  for (std::size_t i = 0; i < ranked.size(); ++i) item.views[i] = ranked[i].second;
  return item;
}

}  // namespace photohull::carving
