#include "mesh/measure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/error.h"
#include "mesh/convex_hull.h"
#include "mesh/oriented_box.h"
#include "support/analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

using testing::HasSubstr;

/// A box from the origin to `size`, turned and moved; each side of n x n squares.
TriMesh box_mesh(const glm::dvec3& size, int n = 1, const glm::dmat3& turn = glm::dmat3(1.0),
                 const glm::dvec3& move = glm::dvec3(0.0)) {
  TriMesh mesh;
  mesh.origin = move;
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto corner = [&](int a, int b) {
            glm::dvec3 p(0.0), normal(0.0);
            p[axis] = side;
            p[(axis + 1) % 3] = double(i + a) / n;
            p[(axis + 2) % 3] = double(j + b) / n;
            normal[axis] = side ? 1 : -1;
            mesh.positions.push_back(glm::vec3(turn * (p * size)));
            mesh.normals.push_back(glm::vec3(turn * normal));
            return std::uint32_t(mesh.positions.size() - 1);
          };
          const std::uint32_t a = corner(0, 0), b = corner(1, 0), c = corner(1, 1),
                              d = corner(0, 1);
          if (side)
            mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
          else
            mesh.triangles.insert(mesh.triangles.end(), {{a, c, b}, {a, d, c}});
        }
  return mesh;
}

glm::dmat3 some_turn() {
  const glm::dvec3 x = glm::normalize(glm::dvec3(1, 2, -0.5)),
                   y = glm::normalize(glm::cross(x, glm::dvec3(0.3, -1, 2)));
  return {x, y, glm::cross(x, y)};
}

TEST(Measure, ABoxHasItsFigures) {
  const Measurements m = measure(box_mesh({2, 3, 5}, 4), {0, 0, 1}, 0.1, {.sections = 7});
  EXPECT_TRUE(m.closed);
  EXPECT_NEAR(m.volume.value().value, 30, 1e-5);
  EXPECT_NEAR(m.area.value, 62, 1e-5);
  EXPECT_NEAR(m.height.value, 5, 1e-6);
  EXPECT_NEAR(m.hull_volume.value, 30, 1e-5);
  EXPECT_NEAR(m.box_volume.value, 30, 1e-5);
  ASSERT_EQ(m.sections.size(), 7u);
  for (const CrossSection& s : m.sections) EXPECT_NEAR(s.area.value, 6, 1e-5);
  EXPECT_NEAR(m.sections[0].position, 5.0 / 14, 1e-6);
  EXPECT_EQ(m.volume->uncertainty, 0);  // without confidence
}

TEST(Measure, TurnedAndFarAway) {
  const TriMesh mesh = box_mesh({2, 3, 5}, 3, some_turn(), {1e6, -2e6, 5e5});
  const Measurements m = measure(mesh, {0, 0, 1}, 0.1);
  EXPECT_NEAR(m.volume.value().value, 30, 1e-4);
  EXPECT_NEAR(m.hull_volume.value, 30, 1e-4);
  EXPECT_NEAR(m.oriented.size.x, 5, 1e-4);
  EXPECT_NEAR(m.oriented.size.y, 3, 1e-4);
  EXPECT_NEAR(m.oriented.size.z, 2, 1e-4);
  EXPECT_NEAR(std::abs(glm::dot(m.oriented.axes[0], some_turn()[2])), 1, 1e-5);
  EXPECT_NEAR(glm::distance(m.oriented.center, mesh.origin + some_turn() * glm::dvec3(1, 1.5, 2.5)),
              0, 1e-4);
  EXPECT_GT(m.box_volume.value, 40);
}

/// A ball of 20 voxels of 0.1, whose vertices all have this confidence.
Measurements measured_ball(float confidence) {
  TriMesh mesh = extract_mesh(sample_volume(glm::ivec3(8), sphere({32, 32, 32}, 20)));
  for (glm::vec3& p : mesh.positions) p *= 0.1f;
  mesh.origin *= 0.1;
  mesh.normals.clear();
  for (std::size_t v = 0; v < mesh.positions.size(); ++v)
    mesh.normals.push_back(glm::vec3(glm::normalize(mesh.world(v) - glm::dvec3(3.2))));
  mesh.confidence.assign(mesh.positions.size(), confidence);
  return measure(mesh, {0, 0, 1}, 0.1);
}

TEST(Measure, UncertaintyIsWhatMovingBySigmaChanges) {
  const double pi = std::acos(-1.0);
  const Measurements m = measured_ball(float(std::erf(1 / std::sqrt(2.0))));  // sigma is a voxel
  EXPECT_NEAR(m.volume.value().value, 4 / 3.0 * pi * 8, 0.3);
  EXPECT_NEAR(m.volume->uncertainty, 4 * pi * 4 * 0.1, 0.1);
  EXPECT_NEAR(m.area.uncertainty, 8 * pi * 2 * 0.1, 0.1);
  EXPECT_NEAR(m.height.uncertainty, 2 * 0.1, 1e-3);
  EXPECT_NEAR(m.hull_volume.uncertainty, 4 * pi * 4 * 0.1, 0.1);
  EXPECT_EQ(m.unseen, 0);
  const Measurements unseen = measured_ball(0);
  EXPECT_NEAR(unseen.height.uncertainty, 3 * 2 * 0.1, 1e-3);  // the most that is assumed
  EXPECT_NEAR(unseen.unseen, 1, 1e-9);
  EXPECT_LT(measured_ball(1).height.uncertainty, 0.05);
}

TEST(Measure, AnOpenMeshHasNoVolume) {
  TriMesh mesh = box_mesh({2, 3, 5});
  mesh.triangles.pop_back();
  const Measurements m = measure(mesh, {0, 0, 1}, 0.1);
  EXPECT_FALSE(m.closed);
  EXPECT_FALSE(m.volume);
  EXPECT_TRUE(m.sections.empty());
  EXPECT_NEAR(m.hull_volume.value, 30, 1e-5);
}

TEST(Measure, SectionsOfTwoBodiesWithAHoleAddUp) {
  TriMesh mesh = box_mesh({1, 1, 4});
  TriMesh hole = box_mesh({0.5, 0.5, 2}, 1, glm::dmat3(1.0));
  for (const glm::vec3& p : hole.positions)
    mesh.positions.push_back(p + glm::vec3(0.25f, 0.25f, 1));
  for (const auto& t : hole.triangles)  // faces inward
    mesh.triangles.push_back({t[0] + 24, t[2] + 24, t[1] + 24});
  mesh.normals.clear();
  const Measurements m = measure(mesh, {0, 0, 1}, 0.1, {.sections = 4});
  EXPECT_NEAR(m.volume.value().value, 3.5, 1e-5);
  EXPECT_NEAR(m.sections[0].area.value, 1, 1e-5);
  EXPECT_NEAR(m.sections[1].area.value, 0.75, 1e-5);
  EXPECT_NEAR(m.sections[2].area.value, 0.75, 1e-5);
  EXPECT_NEAR(m.hull_volume.value, 4, 1e-5);
}

TEST(Measure, NothingIsAnError) {
  try {
    measure({}, {0, 0, 1}, 0.1);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("no triangles"));
  }
  EXPECT_THROW(measure(box_mesh({1, 1, 1}), {0, 0, 1}, 0.1, {.sections = -1}), UsageError);
}

TEST(ConvexHull, HoldsAllPointsAndIsClosed) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (const int count : {4, 10, 2000}) {
    std::vector<glm::dvec3> points;
    for (int i = 0; i < count; ++i)
      points.emplace_back(normal(random), normal(random), normal(random));
    const auto hull = convex_hull(points);
    ASSERT_GE(hull.size(), 4u);
    for (const auto& t : hull) {
      const glm::dvec3 n =
          glm::normalize(glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]));
      for (const glm::dvec3& p : points) EXPECT_LE(glm::dot(n, p - points[t[0]]), 1e-7);
    }
  }
}

TEST(ConvexHull, OfAGridOfPoints) {
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j)
      for (int k = 0; k < 9; ++k) points.emplace_back(i, j, k);
  double volume = 0;
  for (const auto& t : convex_hull(points))
    volume += glm::dot(points[t[0]], glm::cross(points[t[1]], points[t[2]])) / 6;
  EXPECT_NEAR(volume, 512, 1e-9);
}

TEST(ConvexHull, OfPointsInAPlaneIsEmpty) {
  const std::vector<glm::dvec3> flat = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {2, 5, 1}};
  EXPECT_TRUE(convex_hull(flat).empty());
  EXPECT_TRUE(convex_hull(std::vector<glm::dvec3>(9, glm::dvec3(2))).empty());
  EXPECT_TRUE(convex_hull(std::vector<glm::dvec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).empty());
  std::vector<glm::dvec3> line, slanted;
  for (int i = 0; i < 9; ++i) {
    line.emplace_back(0.1 * i, 0.3 * i, -0.2 * i);
    slanted.push_back(0.1 * i * glm::dvec3(1, 2, 3) + double(i % 3) * glm::dvec3(0.3, -0.1, 0.7));
  }
  EXPECT_TRUE(convex_hull(line).empty());
  EXPECT_TRUE(convex_hull(slanted).empty());
  const OrientedBox box = oriented_box(flat);
  EXPECT_NEAR(box.size.z, 0, 1e-12);
}

}  // namespace
}  // namespace photohull
