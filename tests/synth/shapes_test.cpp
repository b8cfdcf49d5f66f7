#include "synth/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "core/disjoint_sets.h"
#include "raycast/ray_scene.h"
#include "synth/mesh_builder.h"
#include "synth/surface.h"

namespace photohull::synth {
namespace {

ShapeValues defaults(const Shape& shape) {
  ShapeValues values;
  for (const ShapeParameter& p : shape.parameters) values[p.name] = p.value;
  return values;
}

/// With the default values; made once.
const TriMesh& usual_shape(const std::string& name) {
  static std::map<std::string, TriMesh> made;
  const auto [it, is_new] = made.try_emplace(name);
  if (is_new) it->second = make_shape(*find_shape(name));
  return it->second;
}

double volume(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += dot(glm::dvec3(mesh.positions[a]),
               cross(glm::dvec3(mesh.positions[b]), glm::dvec3(mesh.positions[c])));
  return sum / 6;
}

/// Edges that are not run through exactly once in each sense.
int open_edges(const TriMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> runs;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++runs[{t[k], t[(k + 1) % 3]}];
  int open = 0;
  for (const auto& [edge, count] : runs) {
    const auto back = runs.find({edge.second, edge.first});
    open += count != 1 || back == runs.end();
  }
  return open;
}

/// Signs of the surface along a line from outside, each +1 entering and -1 leaving.
std::vector<int> crossings(const Surface& s, const glm::dvec3& from, const glm::dvec3& to) {
  std::vector<int> signs;
  double t = 0;
  while (const auto hit = s.rays->closest(from, to - from, t)) {
    const glm::dvec3 n(s.face_normals[hit->triangle]);
    signs.push_back(dot(n, to - from) < 0 ? 1 : -1);
    t = hit->t + 1e-5;
  }
  return signs;
}

/// Numbers of the parts that the vertices belong to.
std::vector<std::uint32_t> parts_of(const TriMesh& mesh) {
  DisjointSets joined(mesh.positions.size());
  for (const auto& [a, b, c] : mesh.triangles) joined.unite(a, b), joined.unite(b, c);
  std::vector<std::uint32_t> parts;
  for (std::uint32_t i = 0; i < joined.size(); ++i) parts.push_back(joined.root(i));
  return parts;
}

/// Edges that run through a triangle of another part: none where parts do not meet.
int meeting_edges(const Surface& s) {
  const std::vector<std::uint32_t> part = parts_of(s.mesh);
  int meeting = 0;
  for (const auto& t : s.mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (a > b) continue;  // every edge once
      const glm::dvec3 from = s.mesh.world(a), along = s.mesh.world(b) - from;
      double start = 0;
      // An edge meets its own part, too, and is to be followed past it.
      while (const auto hit = s.rays->closest(from, along, start, 1)) {
        if (part[s.mesh.triangles[hit->triangle][0]] != part[a]) {
          ++meeting;
          break;
        }
        start = hit->t + 0.01;
      }
    }
  return meeting;
}

class EveryShape : public testing::TestWithParam<std::string> {};

TEST_P(EveryShape, IsClosedAndFacesOutward) {
  const TriMesh& mesh = usual_shape(GetParam());
  EXPECT_GT(mesh.triangles.size(), 20u);
  EXPECT_EQ(open_edges(mesh), 0);
  EXPECT_GT(volume(mesh), 0);
}

TEST_P(EveryShape, HidesNoSurfaceInside) {
  const Surface s = make_surface(usual_shape(GetParam()), GetParam());
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> share(0, 1);
  const auto in_box = [&] {
    return s.box.min + s.box.size() * glm::dvec3(share(engine), share(engine), share(engine));
  };
  int lines = 0, bad = 0;
  for (int i = 0; i < 4000; ++i) {
    const glm::dvec3 inside = in_box(), toward = in_box() - inside;
    const glm::dvec3 from = inside - 2 * s.diagonal * normalize(toward);
    const auto signs = crossings(s, from, inside);
    bool alternates = signs.size() % 2 == 0;
    for (std::size_t k = 0; k < signs.size(); ++k) alternates &= signs[k] == (k % 2 ? -1 : 1);
    lines += !signs.empty();
    bad += !alternates;
  }
  EXPECT_GT(lines, 100);
  // Rays along an edge or closer to the next layer than the step past a hit are rare.
  EXPECT_LE(bad, lines / 200);
}

std::vector<std::string> shape_names() {
  std::vector<std::string> names;
  for (const Shape& s : shapes()) names.push_back(s.name);
  return names;
}

/// Every parameter but the size at one end of its range.
ShapeValues extreme(const Shape& shape, bool high) {
  ShapeValues values = defaults(shape);
  for (const ShapeParameter& p : shape.parameters)
    if (p.high < 100) values[p.name] = high ? p.high : p.low;
  return values;
}

TEST(WireShapes, PartsDoNotMeet) {
  for (const char* name : {"cage", "seedling", "wheel"}) {
    const Shape& shape = *find_shape(name);
    for (const ShapeValues& values :
         {defaults(shape), extreme(shape, false), extreme(shape, true)}) {
      const Surface s = make_surface(make_shape(shape, values), name);
      EXPECT_EQ(meeting_edges(s), 0) << name;
      EXPECT_EQ(open_edges(s.mesh), 0) << name;
    }
  }
  // The measure itself: two tubes that cross, and one beside the other.
  const auto tubes_meet = [](double aside) {
    MeshBuilder builder;
    const auto radius = [](double) { return 0.1; };
    builder.add_tube([](double s) { return glm::dvec3(0, 0, s); }, radius, 8, 12, {1, 0, 0});
    builder.add_tube([&](double s) { return glm::dvec3(s - 0.5, aside, 0.5); }, radius, 8, 12,
                     {0, 0, 1});
    return meeting_edges(make_surface(builder.take(), "tubes")) > 0;
  };
  EXPECT_TRUE(tubes_meet(0.15));
  EXPECT_FALSE(tubes_meet(0.21));
}

TEST(WireShapes, FacetsFollowTheirCurves) {
  // Middles of the facets of the first part, less than 1e-4 of the diagonal off.
  const auto worst = [](const char* name, const std::function<double(const glm::dvec3&)>& off) {
    const TriMesh& mesh = usual_shape(name);
    const std::vector<std::uint32_t> part = parts_of(mesh);
    double most = 0;
    for (const auto& [a, b, c] : mesh.triangles)
      if (part[a] == part[0])
        most = std::max(most, std::abs(off((mesh.world(a) + mesh.world(b) + mesh.world(c)) / 3.0)));
    return most;
  };
  EXPECT_LT(worst("wheel",  // the tyre
                  [](const glm::dvec3& p) {
                    return std::hypot(std::hypot(p.x, p.z - 1) - 0.96, p.y) - 0.04;
                  }),
            1e-4 * std::sqrt(8.0));
  EXPECT_LT(worst("seedling",  // the stem
                  [](const glm::dvec3& p) {
                    const double s = p.z / 2;
                    if (s < 0 || s > 1) return 0.0;  // its round ends
                    return std::hypot(p.x - 0.04 * std::sin(3 * s), p.y - 0.024 * std::sin(5 * s)) -
                           0.00314 * (1 - 0.75 * s);
                  }),
            1e-4 * 2);
}

INSTANTIATE_TEST_SUITE_P(Shapes, EveryShape, testing::ValuesIn(shape_names()),
                         [](const auto& one) { return one.param; });

TEST(Shapes, SphereAndTorusLieOnTheirFormulas) {
  for (const glm::vec3& p : make_shape(*find_shape("sphere"), {{"radius", 2.0}}).positions)
    ASSERT_NEAR(length(glm::dvec3(p)), 2.0, 1e-6);
  for (const glm::vec3& p : usual_shape("torus").positions)
    ASSERT_NEAR(std::hypot(std::hypot(double(p.x), double(p.y)) - 1.0, double(p.z)), 0.4, 1e-6);
}

TEST(Shapes, SphereVolumeIsThatOfABall) {
  const double exact = 4 * M_PI / 3;
  const double found = volume(usual_shape("sphere"));
  EXPECT_LT(found, exact);
  EXPECT_NEAR(found, exact, 3e-4 * exact);
}

TEST(Shapes, GyroidVerticesAreZerosOfItsFunction) {
  const Shape& shape = *find_shape("gyroid");
  const ShapeValues values = defaults(shape);
  double worst = 0;
  for (const glm::vec3& p : usual_shape("gyroid").positions)
    worst = std::max(worst, std::abs(gyroid_field(glm::dvec3(p), values)));
  EXPECT_LT(worst, 1e-6);
}

TEST(Figure, MeshFollowsItsFunction) {
  const Shape& shape = *find_shape("figure");
  for (const double phase : {0.1, 0.6}) {
    ShapeValues values = defaults(shape);
    values["phase"] = phase;
    const TriMesh mesh = make_shape(shape, values);
    double vertices = 0, facets = 0;
    for (std::size_t i = 0; i < mesh.positions.size(); i += 3)
      vertices = std::max(vertices, std::abs(figure_field(mesh.world(i), values)));
    EXPECT_LT(vertices, 1e-6);
    for (std::size_t i = 0; i < mesh.triangles.size(); i += 3) {
      const auto& [a, b, c] = mesh.triangles[i];
      const glm::dvec3 middle = (mesh.world(a) + mesh.world(b) + mesh.world(c)) / 3.0;
      facets = std::max(facets, std::abs(figure_field(middle, values)));
    }
    const Box box = tight_box(mesh);
    EXPECT_NEAR(box.size().z, 2, 0.1);
    // The function changes by three quarters of the distance at least.
    EXPECT_LT(facets, 0.75 * 1e-4 * box.diagonal());
  }
}

TEST(Figure, LimbsMeetAtJointsOnlyInEveryPose) {
  const Shape& shape = *find_shape("figure");
  for (const double swing : {60.0, 25.0})
    for (int step = 0; step < (swing > 30 ? 4 : 2); ++step) {
      const TriMesh mesh = make_shape(shape, {{"phase", step / 4.0}, {"swing", swing}});
      // A surface in one part without handles: Euler's characteristic is 2.
      const std::vector<std::uint32_t> part = parts_of(mesh);
      EXPECT_EQ(std::count(part.begin(), part.end(), part[0]), std::ptrdiff_t(part.size()));
      EXPECT_EQ(std::ptrdiff_t(mesh.positions.size()) - std::ptrdiff_t(mesh.triangles.size() / 2),
                2)
          << swing << " " << step;
    }
}

TEST(Figure, PhaseIsPeriodicAndThePlinthStandsStill) {
  const Shape& shape = *find_shape("figure");
  const TriMesh first = make_shape(shape, {{"phase", 0.0}});
  const TriMesh last = make_shape(shape, {{"phase", 1.0}}),
                half = make_shape(shape, {{"phase", 0.5}});
  ASSERT_EQ(first.triangles.size(), last.triangles.size());
  for (std::size_t i = 0; i < first.positions.size(); ++i)
    ASSERT_LT(length(first.positions[i] - last.positions[i]), 1e-5);
  const auto lowest = [](const TriMesh& mesh) {
    std::vector<std::array<float, 3>> points;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
      if (mesh.world(i).z < 0.14)
        points.push_back({mesh.positions[i].x, mesh.positions[i].y, mesh.positions[i].z});
    return points;
  };
  const auto a = lowest(first), b = lowest(half);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_GT(a.size(), 1000u);
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(a[i][k], b[i][k], 1e-5);
}

TEST(Shapes, BlockHasExactPlanesAndHole) {
  const TriMesh& mesh = usual_shape("block");
  for (const glm::vec3& p : mesh.positions) {
    const bool corner = std::abs(std::abs(p.y) - 0.6f) < 1e-6f;
    const double on_hole = std::hypot(p.x + 0.5, double(p.y));
    ASSERT_TRUE(corner || std::abs(on_hole - 0.275) < 1e-6) << p.x << " " << p.y;
  }
  // Width x depth x height of both halves, less the hole, a polygon of 256 corners.
  const double polygon = 128 * std::sin(2 * M_PI / 256) * 0.275 * 0.275;
  EXPECT_NEAR(volume(mesh), 1.2 * (1.3 + 0.65) - polygon * 1.3, 1e-5);
}

TEST(Shapes, FacetsFollowTheirCurves) {
  // Edge midpoints of ball and ring against the formula: less than 1e-4 of the diagonal.
  const TriMesh& ball = usual_shape("sphere");
  for (const auto& [a, b, c] : ball.triangles) {
    const glm::dvec3 middle = (glm::dvec3(ball.positions[a]) + glm::dvec3(ball.positions[b]) +
                               glm::dvec3(ball.positions[c])) /
                              3.0;
    ASSERT_LT(1 - length(middle), 1e-4 * std::sqrt(12.0));
  }
}

TEST(MeshBuilder, TriangulatesConcavePolygons) {
  const std::vector<glm::dvec2> comb = {{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1},
                                        {3, 1}, {3, 3}, {2, 3}, {2, 1}, {0, 1}};
  for (const bool reversed : {false, true}) {
    std::vector<glm::dvec2> polygon = comb;
    if (reversed) std::reverse(polygon.begin(), polygon.end());
    double area = 0;
    for (const auto& [a, b, c] : triangulate(polygon)) {
      const glm::dvec2 u = polygon[b] - polygon[a], v = polygon[c] - polygon[a];
      const double twice = u.x * v.y - u.y * v.x;
      EXPECT_GT(reversed ? -twice : twice, 0);
      area += twice / 2;
    }
    EXPECT_NEAR(std::abs(area), 9.0, 1e-12);
  }
}

}  // namespace
}  // namespace photohull::synth
