// Shapes of wires thinner than a pixel or two. Parts that seem to touch stand kGap apart, a small
// share of a pixel, so that no surface hides inside another.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "synth/mesh_builder.h"
#include "synth/shape_makers.h"

namespace photohull::synth {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kGoldenAngle = 2.399963229728653;
constexpr double kGap = 1e-4;  ///< between parts, of the shape's size

/// Sides of a tube of this radius (of the shape's size) whose facets keep to it within half of
/// what shapes may deviate.
int tube_columns(double radius) {
  int columns = 12;
  while (radius * (1 - std::cos(kPi / columns)) > 5e-5) columns += 4;
  return columns;
}

/// A ring of this radius and tube radius; `place` sets a point of the ring about the z axis.
void add_ring(MeshBuilder& builder, double radius, double tube, int columns,
              const std::function<glm::dvec3(const glm::dvec3&)>& place) {
  constexpr int kRows = 360;
  builder.add_torus_like(kRows, columns, [&](int row, int column) {
    const double around = 2 * kPi * row / kRows, across = 2 * kPi * column / columns;
    const double out = radius + tube * std::cos(across);
    return place({out * std::cos(around), out * std::sin(around), tube * std::sin(across)});
  });
}

/// A leaf that goes on where a shoot ends, along `along`, and hangs.
void add_leaf(MeshBuilder& builder, const glm::dvec3& foot, const glm::dvec3& along,
              const glm::dvec3& side, double length, double half_thickness) {
  constexpr int kRows = 48, kColumns = 24;
  const glm::dvec3 up = cross(along, side);
  builder.add_sphere_like(kRows, kColumns, [&](int row, int column) {
    // Rows crowd towards the tips, where the outline bends.
    const double t = 0.5 - 0.5 * std::cos(kPi * row / kRows);
    const double across = 2 * kPi * column / kColumns;
    const double wide = row == 0 || row == kRows ? 0 : std::sin(kPi * std::pow(t, 0.8));
    const double y = 0.2 * length * wide * std::cos(across);
    const double z = half_thickness * std::sqrt(wide) * std::sin(across);
    return foot + length * t * along + y * side + z * up - glm::dvec3(0, 0, 0.45 * length * t * t);
  });
}

}  // namespace

TriMesh make_seedling(const ShapeValues& v) {
  const double h = v.at("height"), root = v.at("stem") * h, shoot = v.at("shoot") * h;
  const double reach = v.at("reach") * h, leaf = v.at("leaf") * h, gap = kGap * h;
  const int count = int(std::lround(v.at("shoots")));
  const auto stem_center = [&](double s) {
    return h * glm::dvec3(0.02 * std::sin(3 * s), 0.012 * std::sin(5 * s), s);
  };
  const auto stem_radius = [&](double s) { return root * (1 - (1 - v.at("tip")) * s); };
  const auto shoot_radius = [&](double t) { return shoot * (1 - 0.4 * t); };
  MeshBuilder builder;
  builder.add_tube(stem_center, stem_radius, 80, tube_columns(v.at("stem")), {1, 0, 0});
  for (int i = 0; i < count; ++i) {
    const double s = 0.2 + 0.8 * (i + 0.5) / count, turn = kGoldenAngle * i;
    const glm::dvec3 out(std::cos(turn), std::sin(turn), 0), side(-out.y, out.x, 0);
    const glm::dvec3 begin = stem_center(s) + (stem_radius(s) + shoot + gap) * out;
    // As long as `reach` to half a percent.
    const auto center = [&](double t) {
      return begin + reach * (0.7 * t * out + glm::dvec3(0, 0, 0.45 * t + 0.25 * t * t));
    };
    builder.add_tube(center, shoot_radius, 32, tube_columns(v.at("shoot")), side);
    if (i % 3 == 2) continue;
    const glm::dvec3 along = normalize(center(1) - center(0.999));
    add_leaf(builder, center(1) + (shoot_radius(1) + gap) * along, along, side, leaf,
             std::max(0.012 * leaf, shoot));
  }
  return builder.take();
}

TriMesh make_cage(const ShapeValues& v) {
  const double h = v.at("height"), radius = v.at("radius") * h, wire = v.at("wire") * h;
  const double gap = kGap * h, plate = 0.025 * h, shoulder = h - radius;
  const int wires = int(std::lround(v.at("wires"))), rings = int(std::lround(v.at("rings")));
  const int columns = tube_columns(v.at("wire"));
  MeshBuilder builder;
  const double rim = radius + 0.02 * h;
  builder.add_revolution({{0, 0}, {rim, 0}, {rim, plate}, {0, plate}}, 256);
  // The knob at the top is so large that the wires' ends stand clear of each other around it.
  const double knob = std::max(0.012 * h, 0.2 * wires * (2 * wire + gap));
  builder.add_sphere_like(32, 64, [&](int row, int column) {
    const double polar = kPi * row / 32, angle = 2 * kPi * column / 64;
    const double out = row == 0 || row == 32 ? 0 : std::sin(polar);
    return glm::dvec3(0, 0, h) +
           knob * glm::dvec3(out * std::cos(angle), out * std::sin(angle), std::cos(polar));
  });
  const double arc = kPi / 2 - 2 * std::asin((knob + wire + gap) / (2 * radius));
  const double foot = plate + wire + gap;
  constexpr int kStraight = 8, kSteps = 96;
  for (int i = 0; i < wires; ++i) {
    const double turn = 2 * kPi * i / wires;
    const glm::dvec3 out(std::cos(turn), std::sin(turn), 0);
    const auto center = [&](double s) {
      const double step = s * kSteps - kStraight;
      if (step < 0)
        return radius * out + glm::dvec3(0, 0, shoulder + (shoulder - foot) * step / kStraight);
      const double angle = arc * step / (kSteps - kStraight);
      return radius * std::cos(angle) * out + glm::dvec3(0, 0, shoulder + radius * std::sin(angle));
    };
    builder.add_tube(center, [&](double) { return wire; }, kSteps, columns, {-out.y, out.x, 0});
  }
  // Around the wires and within them, in turn.
  for (int i = 0; i < rings; ++i) {
    const double aside = (i % 2 == 0 ? 1 : -1) * (2 * wire + gap);
    const glm::dvec3 at(0, 0, foot + (shoulder - foot) * (i + 1) / rings);
    add_ring(builder, radius + aside, wire, columns, [&](const glm::dvec3& p) { return p + at; });
  }
  return builder.take();
}

TriMesh make_wheel(const ShapeValues& v) {
  const double d = v.at("diameter"), tyre = v.at("tyre") * d, spoke = v.at("spoke") * d;
  const double gap = kGap * d, rim = 0.01 * d, hub = 0.02 * d, half = 0.05 * d;
  const int count = 2 * int(std::lround(v.at("spokes") / 2));
  // The wheel turns about y and stands on the plane z = 0.
  const auto upright = [&](const glm::dvec3& p) { return glm::dvec3(p.x, p.z, p.y + d / 2); };
  MeshBuilder builder;
  add_ring(builder, d / 2 - tyre, tyre, tube_columns(v.at("tyre")), upright);
  const double rim_radius = d / 2 - 2 * tyre - gap - rim;
  add_ring(builder, rim_radius, rim, tube_columns(0.01), upright);
  const double axle = 0.3 * hub, end = 1.4 * half;
  const glm::dvec2 profile[] = {{0, -end},   {axle, -end}, {axle, -half}, {hub, -half},
                                {hub, half}, {axle, half}, {axle, end},   {0, end}};
  constexpr int kColumns = 64;
  builder.add_sphere_like(7, kColumns, [&](int row, int column) {
    const double angle = 2 * kPi * column / kColumns;
    const glm::dvec2& p = profile[row];
    return upright({p.x * std::cos(angle), p.x * std::sin(angle), p.y});
  });
  // Spokes of one side lean one way, those of the other side the other way: they cross in the
  // pictures and never meet.
  const double lean = glm::radians(30.0), aside = 0.3 * rim, clear = rim + spoke + gap;
  const double outer = rim_radius - std::sqrt(clear * clear - aside * aside);
  for (int i = 0; i < count; ++i) {
    const double way = i % 2 == 0 ? 1 : -1, turn = 2 * kPi * i / count, from = turn - way * lean;
    const glm::dvec3 foot((hub + spoke + gap) * glm::dvec2(std::cos(from), std::sin(from)),
                          way * (half - 2 * spoke));
    const glm::dvec3 top(outer * glm::dvec2(std::cos(turn), std::sin(turn)), way * aside);
    builder.add_tube([&](double s) { return upright(mix(foot, top, s)); },
                     [&](double) { return spoke; }, 16, tube_columns(v.at("spoke")), {0, 1, 0});
  }
  return builder.take();
}

}  // namespace photohull::synth
