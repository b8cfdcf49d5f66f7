#include "synth/mesh_builder.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.h"

namespace photohull::synth {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr double kPi = std::numbers::pi;

double cross2(const glm::dvec2& a, const glm::dvec2& b) { return a.x * b.y - a.y * b.x; }

double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
  return cross2(b - a, c - b);
}

double signed_area(const std::vector<glm::dvec2>& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sum += cross2(polygon[i], polygon[(i + 1) % polygon.size()]);
  return sum / 2;
}

bool in_triangle(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b,
                 const glm::dvec2& c) {
  return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

bool is_ear(const std::vector<glm::dvec2>& polygon, const std::vector<std::uint32_t>& left,
            std::size_t i) {
  const std::size_t n = left.size();
  const std::uint32_t before = left[(i + n - 1) % n], at = left[i], after = left[(i + 1) % n];
  const glm::dvec2 a = polygon[before], b = polygon[at], c = polygon[after];
  if (turn(a, b, c) <= 0) return false;
  return std::none_of(left.begin(), left.end(), [&](std::uint32_t k) {
    return k != before && k != at && k != after && in_triangle(polygon[k], a, b, c);
  });
}

}  // namespace

std::vector<Triangle> triangulate(const std::vector<glm::dvec2>& polygon) {
  std::vector<std::uint32_t> left(polygon.size());
  std::iota(left.begin(), left.end(), 0u);
  const bool reversed = signed_area(polygon) < 0;
  if (reversed) std::reverse(left.begin(), left.end());
  std::vector<Triangle> triangles;
  while (left.size() > 2) {
    std::size_t ear = 0;
    while (ear < left.size() && !is_ear(polygon, left, ear)) ++ear;
    PHOTOHULL_CHECK(ear < left.size());  // every simple polygon has one
    const std::size_t n = left.size();
    Triangle t = {left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]};
    if (reversed) std::swap(t[1], t[2]);
    triangles.push_back(t);
    left.erase(left.begin() + std::ptrdiff_t(ear));
  }
  return triangles;
}

void MeshBuilder::add_part(const std::vector<glm::dvec3>& points,
                           const std::vector<Triangle>& triangles) {
  double volume = 0;
  for (const auto& [a, b, c] : triangles) volume += dot(points[a], cross(points[b], points[c]));
  const auto first = std::uint32_t(mesh_.positions.size());
  for (const glm::dvec3& p : points) mesh_.positions.emplace_back(p);
  for (Triangle t : triangles) {
    if (volume < 0) std::swap(t[1], t[2]);
    mesh_.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

void MeshBuilder::add_sphere_like(int rows, int columns, const Grid& point) {
  PHOTOHULL_CHECK(rows >= 2 && columns >= 3);
  std::vector<glm::dvec3> points = {point(0, 0)};
  for (int row = 1; row < rows; ++row)
    for (int column = 0; column < columns; ++column) points.push_back(point(row, column));
  points.push_back(point(rows, 0));
  const auto at = [&](int row, int column) {
    if (row == 0) return 0u;
    if (row == rows) return std::uint32_t(points.size() - 1);
    return std::uint32_t(1 + (row - 1) * columns + column % columns);
  };
  std::vector<Triangle> triangles;
  for (int row = 0; row < rows; ++row)
    for (int c = 0; c < columns; ++c) {
      if (row > 0) triangles.push_back({at(row, c), at(row, c + 1), at(row + 1, c)});
      if (row < rows - 1) triangles.push_back({at(row, c + 1), at(row + 1, c + 1), at(row + 1, c)});
    }
  add_part(points, triangles);
}

void MeshBuilder::add_torus_like(int rows, int columns, const Grid& point) {
  std::vector<glm::dvec3> points;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) points.push_back(point(row, column));
  const auto at = [&](int row, int column) {
    return std::uint32_t((row % rows) * columns + column % columns);
  };
  std::vector<Triangle> triangles;
  for (int row = 0; row < rows; ++row)
    for (int c = 0; c < columns; ++c) {
      triangles.push_back({at(row, c), at(row, c + 1), at(row + 1, c)});
      triangles.push_back({at(row, c + 1), at(row + 1, c + 1), at(row + 1, c)});
    }
  add_part(points, triangles);
}

void MeshBuilder::add_revolution(const std::vector<glm::dvec2>& profile, int columns) {
  add_sphere_like(int(profile.size()) - 1, columns, [&](int row, int column) {
    const double angle = 2 * kPi * column / columns;
    const glm::dvec2& p = profile[std::size_t(row)];
    return glm::dvec3(p.x * std::cos(angle), p.x * std::sin(angle), p.y);
  });
}

void MeshBuilder::add_extrusion(const std::vector<glm::dvec2>& polygon, double low, double high,
                                const std::function<glm::dvec3(const glm::dvec3&)>& place) {
  const auto n = std::uint32_t(polygon.size());
  std::vector<glm::dvec3> points;
  for (const double height : {low, high})
    for (const glm::dvec2& p : polygon) points.push_back(place({p, height}));
  std::vector<Triangle> triangles;
  for (const auto& [a, b, c] : triangulate(polygon)) {
    triangles.push_back({a, c, b});
    triangles.push_back({a + n, b + n, c + n});
  }
  // The walls follow the polygon's sense, as the caps do.
  for (std::uint32_t i = 0, j = n - 1; i < n; j = i++) {
    triangles.push_back({j, i, i + n});
    triangles.push_back({j, i + n, j + n});
  }
  add_part(points, triangles);
}

void MeshBuilder::add_box(const glm::dvec3& low, const glm::dvec3& high) {
  add_extrusion({{low.x, low.y}, {high.x, low.y}, {high.x, high.y}, {low.x, high.y}}, low.z, high.z,
                [](const glm::dvec3& p) { return p; });
}

void MeshBuilder::add_hollow(const glm::dvec3& low, const glm::dvec3& high) {
  const std::size_t before = mesh_.triangles.size();
  add_box(low, high);
  for (std::size_t t = before; t < mesh_.triangles.size(); ++t)
    std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
}

void MeshBuilder::add_tube(const std::function<glm::dvec3(double)>& center,
                           const std::function<double(double)>& radius, int steps, int columns,
                           const glm::dvec3& side) {
  const int cap = std::max(3, columns / 4);
  const int rows = 2 * cap + steps;
  add_sphere_like(rows, columns, [&](int row, int column) {
    const double s = std::clamp(double(row - cap) / steps, 0.0, 1.0);
    const double below = kPi / 2 * std::max(0, cap - row) / cap;
    const double above = kPi / 2 * std::max(0, row - cap - steps) / cap;
    const glm::dvec3 along =
        normalize(center(std::min(1.0, s + 1e-4)) - center(std::max(0.0, s - 1e-4)));
    const glm::dvec3 u = normalize(cross(along, side)), v = cross(along, u);
    const double angle = 2 * kPi * column / columns;
    const double out = std::cos(below + above);
    return center(s) + radius(s) * (out * (std::cos(angle) * u + std::sin(angle) * v) +
                                    (std::sin(above) - std::sin(below)) * along);
  });
}

}  // namespace photohull::synth
