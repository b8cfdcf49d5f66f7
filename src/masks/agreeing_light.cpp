#include "masks/agreeing_light.h"

#include <tuple>

namespace photohull {
namespace {

/// Visits those of `seen`, in order of brightness, that are alike the i-th.
template <typename Visit>
void for_each_alike(const std::vector<SeenLight>& seen, std::size_t i, const LightWindow& window,
                    const Visit& visit) {
  const SeenLight& own = seen[i];
  const float reach = 0.5f * window.at(own.brightness);
  std::size_t j = i;
  while (j > 0 && own.brightness - seen[j - 1].brightness <= reach) --j;
  for (; j < seen.size() && seen[j].brightness - own.brightness <= reach; ++j) {
    const glm::vec3 off = glm::abs(seen[j].light - own.light);
    if (std::max({off.x, off.y, off.z}) <= reach) visit(j);
  }
}

}  // namespace

std::vector<SeenLight> take_largest_group(std::vector<SeenLight>& seen, const LightWindow& window) {
  std::sort(seen.begin(), seen.end(), [](const SeenLight& a, const SeenLight& b) {
    return std::tie(a.brightness, a.photo) < std::tie(b.brightness, b.photo);
  });
  std::size_t best = 0, most = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    std::size_t count = 0;
    for_each_alike(seen, i, window, [&](std::size_t) { ++count; });
    if (count >= most) best = i, most = count;
  }
  if (seen.empty()) return {};
  std::vector<bool> taken(seen.size(), false);
  for_each_alike(seen, best, window, [&](std::size_t j) { taken[j] = true; });
  std::vector<SeenLight> group, rest;
  for (std::size_t j = 0; j < seen.size(); ++j) (taken[j] ? group : rest).push_back(seen[j]);
  seen = std::move(rest);
  return group;
}

}  // namespace photohull
