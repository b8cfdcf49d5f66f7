#include "core/image_scale.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace photohull {
namespace {

constexpr double kRounding = 1e-9;  // pixels: 3000 * (1 / 3.0) is 1000

}  // namespace

int scaled_length(int length, double scale) {
  PHOTOHULL_CHECK(scale > 0 && scale <= 1);
  return std::max(1, int(std::ceil(length * scale - kRounding)));
}

glm::dvec2 scaled_pixel(const glm::dvec2& pixel, double scale) {
  return (pixel + 0.5) * scale - 0.5;
}

Intrinsics scaled_intrinsics(const Intrinsics& k, double scale) {
  if (scale == 1) return k;
  const glm::dvec2 principal = scaled_pixel({k.cx, k.cy}, scale);
  return {scaled_length(k.width, scale),
          scaled_length(k.height, scale),
          k.fx * scale,
          k.fy * scale,
          k.skew * scale,
          principal.x,
          principal.y};
}

}  // namespace photohull
