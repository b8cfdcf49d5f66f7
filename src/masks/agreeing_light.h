// Which photographs of a place agree on its light.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace photohull {

struct SeenLight {
  glm::vec3 light{0.0f};
  float brightness = 0;  ///< the mean of the channels
  std::size_t photo = 0;
};

/// How much a group may differ in a light: a share of it, but no less than noise does, which is the
/// same in the roots where it is dark.
struct LightWindow {
  float relative = 0, least = 0;
  float at(float light) const { return std::max(relative * light, least); }
};

/// The most of those that are alike one of them in every channel, within half a window to either
/// side; of groups alike in number the brightest. They are taken out of `seen`, whose rest is in
/// the order of brightness.
std::vector<SeenLight> take_largest_group(std::vector<SeenLight>& seen, const LightWindow& window);

}  // namespace photohull
