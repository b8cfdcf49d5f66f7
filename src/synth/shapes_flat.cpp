// Shapes with exact planes and edges.
#include <cmath>
#include <numbers>

#include "synth/mesh_builder.h"
#include "synth/shape_makers.h"

namespace photohull::synth {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
constexpr double kPi = std::numbers::pi;

/// The block's flat faces and its hole, point by point.
struct BlockMesh {
  static constexpr int kRound = 256;  ///< points around the hole, a multiple of 4
  std::vector<glm::dvec3> points;
  std::vector<Triangle> triangles;

  std::uint32_t add(const glm::dvec3& p) {
    points.push_back(p);
    return std::uint32_t(points.size() - 1);
  }
  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangles.push_back({a, b, c});
    triangles.push_back({a, c, d});
  }
  std::uint32_t add_ring(const glm::dvec3& center, double radius) {
    const auto first = std::uint32_t(points.size());
    for (int i = 0; i < kRound; ++i) {
      const double angle = 2 * kPi * (i + 0.5) / kRound - 3 * kPi / 4;
      add(center + radius * glm::dvec3(std::cos(angle), std::sin(angle), 0));
    }
    return first;
  }
  /// A rectangle around a ring; corners counter-clockwise from (-x, -y), as the ring runs.
  void holed(const std::array<std::uint32_t, 4>& corners, std::uint32_t ring, bool up) {
    const auto face = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      triangles.push_back(up ? Triangle{a, b, c} : Triangle{a, c, b});
    };
    constexpr int kQuarter = kRound / 4;
    const auto on_ring = [&](int i) { return ring + std::uint32_t((i + kRound) % kRound); };
    for (int side = 0; side < 4; ++side) {
      // A corner is joined to half a quarter of the ring before and after it.
      for (int i = side * kQuarter - kQuarter / 2; i < side * kQuarter + kQuarter / 2; ++i)
        face(corners[side], on_ring(i + 1), on_ring(i));
      face(corners[side], corners[(side + 1) % 4], on_ring(side * kQuarter + kQuarter / 2));
    }
  }
};

}  // namespace

TriMesh make_block(const ShapeValues& v) {
  const double x = v.at("width") / 2, y = v.at("depth") / 2, high = v.at("height");
  const double low = v.at("step") * high;
  BlockMesh m;
  // The profile in x and z, once at -y (even numbers) and once at +y (odd ones).
  const glm::dvec2 profile[] = {{-x, 0}, {0, 0}, {x, 0}, {x, low}, {0, low}, {0, high}, {-x, high}};
  for (const glm::dvec2& p : profile)
    for (const double side : {-y, y}) m.add({p.x, side, p.y});
  const auto front = [](int i) { return std::uint32_t(2 * i); };
  const auto back = [](int i) { return std::uint32_t(2 * i + 1); };
  for (const Triangle t : {Triangle{1, 2, 3}, {1, 3, 4}, {0, 1, 4}, {0, 4, 5}, {0, 5, 6}}) {
    m.triangles.push_back({front(int(t[0])), front(int(t[1])), front(int(t[2]))});
    m.triangles.push_back({back(int(t[0])), back(int(t[2])), back(int(t[1]))});
  }
  for (const auto& [a, b] : {std::pair{1, 2}, {2, 3}, {3, 4}, {4, 5}, {6, 0}})
    m.quad(front(a), back(a), back(b), front(b));
  const double radius = v.at("hole") * std::min(x, 2 * y) / 2;
  const std::uint32_t bottom = m.add_ring({-x / 2, 0, 0}, radius);
  const std::uint32_t top = m.add_ring({-x / 2, 0, high}, radius);
  m.holed({front(0), front(1), back(1), back(0)}, bottom, false);
  m.holed({front(6), front(5), back(5), back(6)}, top, true);
  for (std::uint32_t i = 0; i < BlockMesh::kRound; ++i) {
    const std::uint32_t j = (i + 1) % BlockMesh::kRound;
    m.quad(bottom + j, bottom + i, top + i, top + j);
  }
  MeshBuilder builder;
  builder.add_part(m.points, m.triangles);
  return builder.take();
}

TriMesh make_steps(const ShapeValues& v) {
  const int count = int(std::lround(v.at("count")));
  const double run = v.at("run"), rise = v.at("rise"), half = v.at("width") / 2;
  std::vector<glm::dvec2> outline = {{count * run, 0}, {0, 0}};
  for (int i = 0; i < count; ++i) {
    outline.push_back({i * run, (i + 1) * rise});
    outline.push_back({(i + 1) * run, (i + 1) * rise});
  }
  MeshBuilder builder;
  builder.add_extrusion(outline, -half, half,
                        [](const glm::dvec3& p) { return glm::dvec3(p.x, p.z, p.y); });
  return builder.take();
}

TriMesh make_arch(const ShapeValues& v) {
  const double x = v.at("width") / 2, inner = x * v.at("passage");
  const double spring = std::max(0.0, v.at("height") - inner) * 0.6;
  const double crown = (v.at("height") - spring) * 0.85;
  std::vector<glm::dvec2> outline = {{x, 0}, {x, v.at("height")}, {-x, v.at("height")}, {-x, 0}};
  constexpr int kSteps = 128;
  outline.push_back({-inner, 0});
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = kPi - kPi * i / kSteps;
    outline.push_back(
        {inner * std::cos(angle), spring + std::min(inner, crown) * std::sin(angle) + 1e-9});
  }
  outline.push_back({inner, 0});
  const double half = v.at("depth") / 2;
  MeshBuilder builder;
  builder.add_extrusion(outline, -half, half,
                        [](const glm::dvec3& p) { return glm::dvec3(p.x, p.z, p.y); });
  return builder.take();
}

TriMesh make_rods(const ShapeValues& v) {
  const double w = v.at("width"), h = v.at("height"), gap = v.at("gap") * w;
  const double rod = v.at("rod") * w, plate = v.at("plate") * w;
  const int count = int(std::lround(v.at("count")));
  MeshBuilder builder;
  builder.add_box({-w / 2, 0, 0}, {w / 2, 0.06 * w, h});
  // Upright rods over the left three fifths, each thinner than the one before, down to a third.
  for (int i = 0; i < count; ++i) {
    const double x = w * (-0.45 + 0.55 * (i + 0.5) / count);
    const double radius = rod * (1 - (count > 1 ? 2.0 / 3 * i / (count - 1) : 0));
    builder.add_tube([&](double s) { return glm::dvec3(x, -gap, h * (0.08 + 0.84 * s)); },
                     [&](double) { return radius; }, 40, 24, {1, 0, 0});
  }
  // One slanting rod further in front, so that rods cross in the pictures.
  builder.add_tube(
      [&](double s) { return glm::dvec3(w * (-0.45 + 0.6 * s), -1.5 * gap, h * (0.15 + 0.6 * s)); },
      [&](double) { return rod; }, 60, 24, {0, 1, 0});
  // Two plates on edge and a ring over the right two fifths.
  for (const double x : {0.2, 0.42})
    builder.add_box({x * w - plate / 2, -gap - 0.08 * w, 0.1 * h},
                    {x * w + plate / 2, -gap + 0.08 * w, 0.55 * h});
  const double ring = 0.1 * w;
  const glm::dvec3 center(0.31 * w, -gap, 0.78 * h);
  constexpr int kRows = 240, kColumns = 24;
  builder.add_torus_like(kRows, kColumns, [&](int row, int column) {
    const double around = 2 * kPi * row / kRows, across = 2 * kPi * column / kColumns;
    const double out = ring + rod * std::cos(across);
    return center +
           glm::dvec3(out * std::cos(around), rod * std::sin(across), out * std::sin(around));
  });
  return builder.take();
}

TriMesh make_room(const ShapeValues& v) {
  const glm::dvec3 half(v.at("width") / 2, v.at("depth") / 2, v.at("height") / 2);
  const double wall = v.at("wall") * v.at("width"), gap = 2e-4 * half.x;
  MeshBuilder builder;
  builder.add_box(-half - wall, half + wall);
  builder.add_hollow(-half, half);
  // In shares of the room's halves; what stands on the floor or at a wall does not touch it.
  const auto furniture = [&](const glm::dvec3& low, const glm::dvec3& high) {
    builder.add_box(glm::max(low * half, -half + gap), glm::min(high * half, half - gap));
  };
  furniture({-0.2, -0.25, -0.5}, {0.25, 0.2, -0.44});   // the table's top
  furniture({-0.03, -0.06, -1}, {0.07, 0.04, -0.501});  // and its leg
  furniture({-0.75, 0.7, -1}, {-0.2, 1, 0.3});          // a cupboard
  furniture({0.6, -0.8, -1}, {0.75, -0.62, 1});         // a column
  furniture({0.55, 0.5, -1}, {0.9, 0.8, -0.55});        // a box
  return builder.take();
}

}  // namespace photohull::synth
