// Rays against boxes.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "core/box.h"

namespace photohull {

/// The part of the ray origin + t * direction, t >= 0, that lies in the box, as its two t; nothing
/// where it misses or only touches [Kay86].
inline std::optional<std::pair<double, double>> clip_ray(const Box& box, const glm::dvec3& origin,
                                                         const glm::dvec3& direction) {
  double from = 0, to = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double a = (box.min[i] - origin[i]) / direction[i];
    const double b = (box.max[i] - origin[i]) / direction[i];
    if (std::isnan(a) || std::isnan(b)) continue;  // in a face's plane
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  if (!(from < to)) return std::nullopt;
  return std::pair(from, to);
}

}  // namespace photohull
