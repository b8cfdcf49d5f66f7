// Masks whose coverage is exactly the area that polygons cover.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

#include "core/image.h"

namespace photohull::test {

using Polygon = std::vector<glm::dvec2>;

/// The part of a convex polygon where sign * p[axis] <= sign * bound.
inline Polygon clip(const Polygon& polygon, int axis, double sign, double bound) {
  Polygon out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    const double da = sign * (a[axis] - bound), db = sign * (b[axis] - bound);
    if (da <= 0) out.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) out.push_back(a + da / (da - db) * (b - a));
  }
  return out;
}

inline double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  return std::abs(twice) / 2;
}

/// Shapes that do not overlap; pixel centres are whole numbers.
class Drawing {
 public:
  Drawing(int width, int height)
      : width_(width), height_(height), area_(std::size_t(width) * std::size_t(height)) {}

  void add(const Polygon& convex) {
    glm::dvec2 low(1e9), high(-1e9);
    for (const glm::dvec2& p : convex) low = glm::min(low, p), high = glm::max(high, p);
    for (int y = std::max(0, int(low.y - 0.5)); y <= std::min(height_ - 1.0, high.y + 0.5); ++y) {
      const Polygon row = clip(clip(convex, 1, -1, y - 0.5), 1, 1, y + 0.5);
      glm::dvec2 from(1e9), to(-1e9);
      for (const glm::dvec2& p : row) from = glm::min(from, p), to = glm::max(to, p);
      for (int x = std::max(0, int(from.x - 0.5)); x <= std::min(width_ - 1.0, to.x + 0.5); ++x)
        area_[std::size_t(y) * std::size_t(width_) + std::size_t(x)] +=
            area(clip(clip(row, 0, -1, x - 0.5), 0, 1, x + 0.5));
    }
  }

  /// A straight band from a to b whose ends are flat.
  void add_band(const glm::dvec2& a, const glm::dvec2& b, double width) {
    const glm::dvec2 along = glm::normalize(b - a),
                     half = 0.5 * width * glm::dvec2(-along.y, along.x);
    add({a - half, b - half, b + half, a + half});
  }

  void add_disc(const glm::dvec2& centre, double radius) {
    Polygon polygon;
    for (int i = 0; i < 360; ++i)
      polygon.push_back(centre +
                        radius * glm::dvec2(std::cos(i * M_PI / 180), std::sin(i * M_PI / 180)));
    add(polygon);
  }

  Mask mask() const {
    return to_mask([](double a) { return std::lround(255 * std::min(a, 1.0)); });
  }
  /// Pixels that are covered by half or more.
  Mask hard_mask() const {
    return to_mask([](double a) { return a >= 0.5 ? 255 : 0; });
  }

 private:
  template <typename F>
  Mask to_mask(F&& coverage) const {
    Mask mask{width_, height_, {}};
    for (const double a : area_) mask.coverage.push_back(std::uint8_t(coverage(a)));
    return mask;
  }

  int width_, height_;
  std::vector<double> area_;
};

}  // namespace photohull::test
