#include "mesh/oriented_box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "mesh/convex_hull.h"

namespace photohull {
namespace {

constexpr std::size_t kMostDirections = 300;
constexpr double kSameDirection = 1e-6;

double cross(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

/// Corners of the convex hull in the plane, counter-clockwise [Andrew79].
std::vector<glm::dvec2> hull_of(std::vector<glm::dvec2> points) {
  std::ranges::sort(points, [](const glm::dvec2& a, const glm::dvec2& b) {
    return a.x < b.x || (a.x == b.x && a.y < b.y);
  });
  std::vector<glm::dvec2> hull;
  for (int half = 0; half < 2; ++half) {
    const std::size_t start = hull.size();
    for (const glm::dvec2& p : points) {
      while (hull.size() >= start + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 0)
        hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

/// The direction of the edge whose rectangle around the points has the least area.
glm::dvec2 best_direction(const std::vector<glm::dvec2>& hull) {
  double least = std::numeric_limits<double>::infinity();
  glm::dvec2 best(1, 0);
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const glm::dvec2 edge = hull[(i + 1) % hull.size()] - hull[i];
    if (!(glm::length(edge) > 0)) continue;
    const glm::dvec2 u = glm::normalize(edge), v(-u.y, u.x);
    double low = 1e300, high = -1e300, top = -1e300, bottom = 1e300;
    for (const glm::dvec2& p : hull) {
      low = std::min(low, glm::dot(u, p)), high = std::max(high, glm::dot(u, p));
      bottom = std::min(bottom, glm::dot(v, p)), top = std::max(top, glm::dot(v, p));
    }
    if (const double area = (high - low) * (top - bottom); area < least) least = area, best = u;
  }
  return best;
}

/// Around the points, along these axes.
OrientedBox box_along(const glm::dmat3& axes, std::span<const glm::dvec3> points) {
  glm::dvec3 low(1e300), high(-1e300);
  for (const glm::dvec3& p : points) {
    const glm::dvec3 q = glm::transpose(axes) * p;
    low = glm::min(low, q), high = glm::max(high, q);
  }
  return {axes * (0.5 * (low + high)), axes, high - low};
}

double volume_of(const OrientedBox& box) { return box.size.x * box.size.y * box.size.z; }

/// Directions to try: normals of the largest faces, each direction once, and the world's axes.
std::vector<glm::dvec3> directions_of(std::span<const glm::dvec3> points,
                                      const std::vector<std::array<std::uint32_t, 3>>& faces) {
  std::vector<glm::dvec3> normals;
  for (const auto& t : faces)
    normals.push_back(glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]));
  std::ranges::sort(normals, std::ranges::greater(),
                    [](const glm::dvec3& n) { return glm::length(n); });
  std::vector<glm::dvec3> out = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const glm::dvec3& n : normals) {
    if (out.size() >= kMostDirections || !(glm::length(n) > 0)) break;
    const glm::dvec3 unit = glm::normalize(n);
    if (std::ranges::none_of(out, [&](const glm::dvec3& o) {
          return std::abs(glm::dot(o, unit)) > 1 - kSameDirection;
        }))
      out.push_back(unit);
  }
  return out;
}

/// The longest axis first, right-handed.
OrientedBox sorted(const OrientedBox& box) {
  std::array<int, 3> order = {0, 1, 2};
  std::ranges::stable_sort(order, std::ranges::greater(), [&](int axis) { return box.size[axis]; });
  OrientedBox out{box.center, {}, {}};
  for (int i = 0; i < 3; ++i) {
    out.axes[i] = box.axes[order[std::size_t(i)]];
    out.size[i] = box.size[order[std::size_t(i)]];
  }
  if (glm::determinant(out.axes) < 0) out.axes[2] = -out.axes[2];
  return out;
}

}  // namespace

OrientedBox oriented_box(std::span<const glm::dvec3> points) {
  const auto faces = convex_hull(points);
  std::vector<glm::dvec3> corners;
  std::vector<bool> taken(points.size(), faces.empty());
  for (const auto& t : faces)
    for (const std::uint32_t v : t) taken[v] = true;
  for (std::size_t v = 0; v < points.size(); ++v)
    if (taken[v]) corners.push_back(points[v]);
  OrientedBox best = box_along(glm::dmat3(1.0), corners);
  for (const glm::dvec3& n : directions_of(points, faces)) {
    const glm::dvec3 other = std::abs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 a = glm::normalize(glm::cross(n, other)), b = glm::cross(n, a);
    std::vector<glm::dvec2> flat;
    for (const glm::dvec3& p : corners) flat.emplace_back(glm::dot(a, p), glm::dot(b, p));
    const glm::dvec2 u = best_direction(hull_of(std::move(flat)));
    const glm::dvec3 first = u.x * a + u.y * b;
    const OrientedBox box = box_along(glm::dmat3(first, glm::cross(n, first), n), corners);
    if (volume_of(box) < volume_of(best)) best = box;
  }
  return sorted(best);
}

}  // namespace photohull
