#include "masks/line_chains.h"

#include <cmath>
#include <unordered_map>

namespace photohull {
namespace {

constexpr double kLink = 2.0;      // pixels between neighbours on a line, at most
constexpr double kMostBend = 0.5;  // sine of the angle between a line and the next point

bool follows(const LinePoint& a, const LinePoint& b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length = std::hypot(dx, dy);
  const auto bends = [&](const LinePoint& p) {
    return std::abs(dx * p.normal_x + dy * p.normal_y) > kMostBend * length;
  };
  return length <= kLink && !bends(a) && !bends(b);
}

}  // namespace

std::vector<std::uint32_t> lines_of(std::span<const LinePoint> points) {
  const auto key = [](int x, int y) { return (std::int64_t(y) << 32) + x; };
  std::unordered_multimap<std::int64_t, std::uint32_t> at;
  at.reserve(points.size());
  std::vector<std::uint32_t> parent(points.size());
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    parent[i] = i;
    const int x = int(std::lround(points[i].x)), y = int(std::lround(points[i].y));
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        const auto [from, to] = at.equal_range(key(x + dx, y + dy));
        for (auto other = from; other != to; ++other)
          if (follows(points[i], points[other->second])) parent[root(i)] = root(other->second);
      }
    at.emplace(key(x, y), i);
  }
  for (std::uint32_t i = 0; i < points.size(); ++i) parent[i] = root(i);
  return parent;
}

}  // namespace photohull
