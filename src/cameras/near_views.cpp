#include "cameras/near_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace photohull {
namespace {

/// Root mean square distance of the centres from their mean.
double spread_of_centres(std::span<const Camera> cameras) {
  glm::dvec3 mean(0.0);
  for (const Camera& camera : cameras) mean += camera.center() / double(cameras.size());
  double sum = 0;
  for (const Camera& camera : cameras) {
    const glm::dvec3 off = camera.center() - mean;
    sum += glm::dot(off, off);
  }
  return std::sqrt(sum / double(cameras.size()));
}

}  // namespace

std::vector<int> nearest_views(std::span<const Camera> cameras, int view, int count,
                               double largest_angle) {
  const double spread = std::max(spread_of_centres(cameras), 1e-300);
  const double most = largest_angle * std::numbers::pi / 180;
  const Camera& own = cameras[std::size_t(view)];
  std::vector<std::pair<double, int>> others;
  for (int j = 0; j < int(cameras.size()); ++j) {
    const Camera& other = cameras[std::size_t(j)];
    const double angle = std::acos(std::clamp(glm::dot(own.forward(), other.forward()), -1.0, 1.0));
    if (j != view && angle < most)
      others.emplace_back(angle + glm::distance(own.center(), other.center()) / spread, j);
  }
  std::sort(others.begin(), others.end());
  std::vector<int> nearest;
  for (std::size_t k = 0; k < std::min(others.size(), std::size_t(count)); ++k)
    nearest.push_back(others[k].second);
  return nearest;
}

}  // namespace photohull
