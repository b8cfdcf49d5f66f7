// Shapes with the topology of a sphere or a torus, straight from their formulas.
#include <cmath>
#include <numbers>

#include "synth/mesh_builder.h"
#include "synth/shape_makers.h"

namespace photohull::synth {
namespace {

constexpr double kPi = std::numbers::pi;

/// Points of an arc about `center`, from angle `from` to `to`, without the first.
void add_arc(std::vector<glm::dvec2>& profile, const glm::dvec2& center, const glm::dvec2& radii,
             double from, double to, int steps) {
  for (int i = 1; i <= steps; ++i) {
    const double angle = from + (to - from) * i / steps;
    profile.push_back(center + radii * glm::dvec2(std::cos(angle), std::sin(angle)));
  }
}

/// Points of a straight line, without the first.
void add_line(std::vector<glm::dvec2>& profile, const glm::dvec2& to, int steps) {
  const glm::dvec2 from = profile.back();
  for (int i = 1; i <= steps; ++i) profile.push_back(mix(from, to, double(i) / steps));
}

/// A cubic from the last point, tangents given (Hermite), without the first point.
void add_curve(std::vector<glm::dvec2>& profile, const glm::dvec2& tangent_from,
               const glm::dvec2& to, const glm::dvec2& tangent_to, int steps) {
  const glm::dvec2 from = profile.back();
  for (int i = 1; i <= steps; ++i) {
    const double s = double(i) / steps, r = 1 - s;
    profile.push_back((1 + 2 * s) * r * r * from + s * r * r * tangent_from +
                      s * s * (3 - 2 * s) * to - s * s * r * tangent_to);
  }
}

}  // namespace

TriMesh make_sphere(const ShapeValues& v) {
  constexpr int kRows = 200, kColumns = 400;
  const double radius = v.at("radius");
  MeshBuilder builder;
  builder.add_sphere_like(kRows, kColumns, [&](int row, int column) {
    const double polar = kPi * row / kRows, angle = 2 * kPi * column / kColumns;
    // The poles exactly: sin(pi) is not zero in floating point.
    const double out = row == 0 || row == kRows ? 0 : std::sin(polar);
    return radius * glm::dvec3(out * std::cos(angle), out * std::sin(angle), std::cos(polar));
  });
  return builder.take();
}

TriMesh make_torus(const ShapeValues& v) {
  constexpr int kRows = 480, kColumns = 200;
  const double radius = v.at("radius"), tube = v.at("tube") * radius;
  MeshBuilder builder;
  builder.add_torus_like(kRows, kColumns, [&](int row, int column) {
    const double around = 2 * kPi * row / kRows, across = 2 * kPi * column / kColumns;
    const double out = radius + tube * std::cos(across);
    return glm::dvec3(out * std::cos(around), out * std::sin(around), tube * std::sin(across));
  });
  return builder.take();
}

TriMesh make_pawn(const ShapeValues& v) {
  // Radius and height in shares of the foot's radius and of the height.
  std::vector<glm::dvec2> p = {{0, 0}};
  add_line(p, {0.96, 0}, 8);
  add_arc(p, {0.96, 0.05}, {0.1, 0.05}, -kPi / 2, kPi / 2, 40);  // the foot's bead
  add_line(p, {0.84, 0.10}, 2);
  add_arc(p, {0.84, 0.135}, {0.06, 0.035}, 3 * kPi / 2, kPi / 2, 40);  // a groove
  add_line(p, {0.88, 0.17}, 2);
  add_curve(p, {0.0, 0.12}, {0.34, 0.52}, {-0.08, 0.45}, 80);  // the flowing waist
  add_curve(p, {-0.04, 0.16}, {0.62, 0.66}, {0.5, 0.02}, 60);  // out to the collar
  add_arc(p, {0.62, 0.68}, {0.05, 0.02}, -kPi / 2, kPi / 2, 30);
  add_line(p, {0.36, 0.71}, 6);  // the collar's top, sharp at the neck
  add_arc(p, {0.36, 0.73}, {0.05, 0.02}, 3 * kPi / 2, kPi / 2, 30);
  // The head: an ellipsoid of revolution that starts at the neck, a round ball by default.
  const double neck = 0.36, below = 0.24, ball = std::hypot(neck, below), flat = 0.28;
  const glm::dvec2 center(0, 0.75 + flat * below);
  add_arc(p, center, {ball, ball * flat}, -std::atan2(below, neck), kPi / 2, 120);
  const double top = center.y + ball * flat;
  p.back().x = 0;
  for (glm::dvec2& q : p) q *= glm::dvec2(v.at("radius"), v.at("height") / top);
  p.front().x = 0;
  MeshBuilder builder;
  builder.add_revolution(p, 360);
  return builder.take();
}

TriMesh make_bowl(const ShapeValues& v) {
  const double radius = v.at("radius"), height = v.at("height");
  const double wall = v.at("thickness") * std::min(radius, height);
  constexpr int kSteps = 160;
  std::vector<glm::dvec2> p = {{0, 0}};
  add_arc(p, {0, height}, {radius, height}, -kPi / 2, 0, kSteps);
  add_arc(p, {radius - wall / 2, height}, {wall / 2, wall / 2}, 0, kPi, 40);
  add_arc(p, {0, height}, {radius - wall, height - wall}, 0, -kPi / 2, kSteps);
  p.back().x = 0;
  MeshBuilder builder;
  builder.add_revolution(p, 400);
  return builder.take();
}

TriMesh make_folds(const ShapeValues& v) {
  constexpr int kRows = 320, kColumns = 960;
  const double radius = v.at("radius"), half = v.at("height") / 2;
  const double count = std::round(v.at("count")), depth = v.at("depth");
  MeshBuilder builder;
  builder.add_sphere_like(kRows, kColumns, [&](int row, int column) {
    const double polar = kPi * row / kRows, around = 2 * kPi * column / kColumns;
    const double ring = row == 0 || row == kRows ? 0 : std::sin(polar);
    // At every height a star whose rays are sheared about the axis: never cuts itself.
    const double star = 1 + depth * ring * ring * std::cos(count * around);
    const double angle =
        around + v.at("lean") * (star - 1) / 0.4 * ring + v.at("twist") * std::cos(polar);
    return glm::dvec3(radius * ring * star * std::cos(angle),
                      radius * ring * star * std::sin(angle), half * std::cos(polar));
  });
  return builder.take();
}

}  // namespace photohull::synth
