#include "core/sheet_light.h"

#include <algorithm>
#include <cmath>

namespace photohull {

SheetLight::Texel SheetLight::at(const glm::dvec2& place) const {
  const glm::dvec2 q = (place - lower_left) * texels_per_mm;
  const double x = std::clamp(q.x - 0.5, 0.0, width - 1.0);
  const double y = std::clamp(height - q.y - 0.5, 0.0, height - 1.0);
  const int x0 = std::min(int(x), std::max(0, width - 2));
  const int y0 = std::min(int(y), std::max(0, height - 2));
  const float u = float(x - x0), v = float(y - y0);
  const std::size_t i = std::size_t(y0) * std::size_t(width) + std::size_t(x0);
  const std::size_t right = width > 1 ? 1 : 0, below = height > 1 ? std::size_t(width) : 0;
  return {(1 - v) * ((1 - u) * paper[i] + u * paper[i + right]) +
              v * ((1 - u) * paper[i + below] + u * paper[i + below + right]),
          agreed[i] && agreed[i + right] && agreed[i + below] && agreed[i + below + right]};
}

}  // namespace photohull
