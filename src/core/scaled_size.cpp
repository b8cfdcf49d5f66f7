#include "core/scaled_size.h"

#include <algorithm>
#include <cstdlib>

#include "core/error.h"

namespace photohull {
namespace {

constexpr int kLeastChange = 2;  // pixels

/// Is there a factor that puts each of the scaled sides into [side + low, side + high]?
bool some_factor(double width, double height, double from_width, double from_height, double low,
                 double high) {
  return std::max((width + low) / from_width, (height + low) / from_height) <=
         std::min((width + high) / from_width, (height + high) / from_height);
}

}  // namespace

bool is_scaled_copy(int width, int height, int from_width, int from_height) {
  if (std::min({width, height, from_width, from_height}) <= 0) return false;
  if (std::max(std::abs(width - from_width), std::abs(height - from_height)) < kLeastChange)
    return false;
  constexpr double kNearlyOne = 1 - 1e-9;  // rounding down takes less than a pixel
  const auto fits = [&](double low, double high) {
    return some_factor(width, height, from_width, from_height, low, high);
  };
  return fits(-0.5, 0.5) || fits(0, kNearlyOne) || fits(-kNearlyOne, 0);
}

Intrinsics scaled_to(const Intrinsics& k, int width, int height) {
  PHOTOHULL_CHECK(k.width > 0 && k.height > 0);
  const double x = double(width) / k.width, y = double(height) / k.height;
  const glm::dvec2 centre = scaled_to(glm::dvec2(k.cx, k.cy), k, width, height);
  return {width, height, x * k.fx, y * k.fy, x * k.skew, centre.x, centre.y};
}

glm::dvec2 scaled_to(const glm::dvec2& pixel, const Intrinsics& k, int width, int height) {
  const glm::dvec2 factor(double(width) / k.width, double(height) / k.height);
  return factor * (pixel + 0.5) - 0.5;
}

}  // namespace photohull
