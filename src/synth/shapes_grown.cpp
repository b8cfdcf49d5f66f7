// Shapes of many thin parts. Parts that seem to touch stand a little apart, less than a pixel at
// the usual camera, so that no surface hides inside another.
#include <cmath>
#include <numbers>

#include "synth/mesh_builder.h"
#include "synth/shape_makers.h"

namespace photohull::synth {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGoldenAngle = 2.399963229728653;

/// A leaf's outline: half width over length, 0 at both tips.
double outline(double s) { return std::sin(kPi * std::pow(s, 0.8)); }

}  // namespace

TriMesh make_leaves(const ShapeValues& v) {
  const int count = int(std::lround(v.at("count")));
  const double length = v.at("length"), half_width = v.at("width") * length / 2;
  const double spacing = v.at("spacing") * length, thick = v.at("thickness") * length / 2;
  const double stalk = 0.04 * length, start = 0.06 * length;
  constexpr int kRows = 160, kColumns = 64;
  MeshBuilder builder;
  for (int leaf = 0; leaf < count; ++leaf) {
    const double turn = kGoldenAngle * leaf;
    builder.add_sphere_like(kRows, kColumns, [&](int row, int column) {
      // Rows crowd towards the tips, where the outline bends.
      const double s = 0.5 - 0.5 * std::cos(kPi * row / kRows);
      const double across = 2 * kPi * column / kColumns;
      const double wide = row == 0 || row == kRows ? 0 : outline(s);
      const double x = start + (length - start) * s, y = half_width * wide * std::cos(across);
      // Every leaf bends by the same function of the distance from the stalk: none meet.
      const double r = std::hypot(x, y) / length;
      const double bend = length * (0.35 * r - (0.35 + v.at("droop")) * r * r);
      const double z = spacing * (leaf + 1) + bend + thick * std::sqrt(wide) * std::sin(across);
      return glm::dvec3(x * std::cos(turn) - y * std::sin(turn),
                        x * std::sin(turn) + y * std::cos(turn), z);
    });
  }
  const double top = spacing * (count + 1.5);
  builder.add_tube(
      [&](double s) { return glm::dvec3(0, 0, -0.3 * length + s * (top + 0.3 * length)); },
      [&](double s) { return stalk * (1 - 0.4 * s); }, 20, 48, {1, 0, 0});
  return builder.take();
}

TriMesh make_plant(const ShapeValues& v) {
  const double h = v.at("height"), root = v.at("stem") * h, twig = v.at("branch") * h;
  const double leaf_length = v.at("leaf") * h, gap = 4e-4 * h;
  const int count = int(std::lround(v.at("branches")));
  const auto stem_center = [&](double s) {
    return glm::dvec3(0.02 * h * std::sin(4 * s), 0.015 * h * std::sin(3 * s), h * s);
  };
  const auto stem_radius = [&](double s) { return root * (1 - 0.75 * s); };
  MeshBuilder builder;
  builder.add_tube(stem_center, stem_radius, 160, 40, {1, 0, 0});
  for (int i = 0; i < count; ++i) {
    const double s = 0.15 + 0.8 * (i + 0.5) / count, turn = kGoldenAngle * i;
    const double reach = h * (0.28 - 0.16 * s);
    const glm::dvec3 out(std::cos(turn), std::sin(turn), 0), side(-out.y, out.x, 0);
    const glm::dvec3 begin = stem_center(s) + (stem_radius(s) + twig + gap) * out;
    const auto center = [&](double t) {
      return begin + reach * (t * out + glm::dvec3(0, 0, 0.55 * t * t + 0.2 * t));
    };
    const auto radius = [&](double t) { return twig * (1 - 0.4 * t); };
    builder.add_tube(center, radius, 48, 16, side);
    // The leaf goes on where the branch ends, and hangs.
    const glm::dvec3 tip = center(1), along = normalize(center(1) - center(0.999));
    const glm::dvec3 foot = tip + (radius(1) + gap) * along;
    constexpr int kRows = 96, kColumns = 40;
    builder.add_sphere_like(kRows, kColumns, [&](int row, int column) {
      const double t = 0.5 - 0.5 * std::cos(kPi * row / kRows);
      const double across = 2 * kPi * column / kColumns;
      const double wide = row == 0 || row == kRows ? 0 : outline(t);
      const glm::dvec3 up = cross(along, side);
      const double y = 0.2 * leaf_length * wide * std::cos(across);
      const double z = 0.012 * leaf_length * std::sqrt(wide) * std::sin(across);
      const double droop = 0.45 * leaf_length * t * t;
      return foot + leaf_length * t * along + y * side + z * up - glm::dvec3(0, 0, droop);
    });
  }
  return builder.take();
}

}  // namespace photohull::synth
