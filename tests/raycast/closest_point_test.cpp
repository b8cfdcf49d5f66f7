#include "raycast/closest_point.h"

#include <gtest/gtest.h>

#include <random>

#include "core/error.h"

namespace photohull {
namespace {

/// The least value of a convex function of a number in [0, high], by ternary search.
template <typename Function>
double least(double high, Function f) {
  double low = 0;
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    f(a) < f(b) ? high = b : low = a;
  }
  return f(0.5 * (low + high));
}

/// Distance to a triangle by a search over its points.
double searched_distance(const glm::dvec3& p, const std::array<glm::dvec3, 3>& t) {
  return least(1, [&](double u) {
    return least(1 - u, [&](double v) {
      return glm::distance(p, t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]));
    });
  });
}

class RandomPoints {
 public:
  explicit RandomPoints(unsigned seed) : random_(seed) {}
  double number(double low, double high) {
    return std::uniform_real_distribution<>(low, high)(random_);
  }
  glm::dvec3 point(double reach = 1) {
    return {number(-reach, reach), number(-reach, reach), number(-reach, reach)};
  }

 private:
  std::mt19937 random_;
};

TEST(ClosestOnTriangle, AgreesWithASearchAndItsWeightsGiveThePoint) {
  RandomPoints random(1);
  for (int i = 0; i < 1000; ++i) {
    std::array<glm::dvec3, 3> t = {random.point(), random.point(), random.point()};
    if (i % 5 == 1) t[2] = t[0] + random.number(-1, 2) * (t[1] - t[0]) + 1e-9 * random.point();
    if (i % 5 == 2) t[2] = t[1];
    if (i % 5 == 3) t[1] = t[2] = t[0];
    const glm::dvec3 p = random.point(2);
    const TrianglePoint found = closest_on_triangle(p, t);
    const glm::dvec3& w = found.weights;
    ASSERT_NEAR(std::sqrt(found.squared_distance), searched_distance(p, t), 1e-9) << i;
    ASSERT_NEAR(glm::distance(p, found.point), std::sqrt(found.squared_distance), 1e-14) << i;
    ASSERT_NEAR(w.x + w.y + w.z, 1, 1e-14) << i;
    ASSERT_TRUE(w.x >= 0 && w.y >= 0 && w.z >= 0) << i;
    ASSERT_NEAR(glm::distance(w.x * t[0] + w.y * t[1] + w.z * t[2], found.point), 0, 1e-14) << i;
  }
}

TEST(ClosestOnTriangle, ZeroWeightsTellEdgesAndCorners) {
  const std::array<glm::dvec3, 3> t = {glm::dvec3(0, 0, 0), {2, 0, 0}, {0, 2, 0}};
  EXPECT_EQ(closest_on_triangle({0.5, 0.5, 3}, t).weights, glm::dvec3(0.5, 0.25, 0.25));
  EXPECT_EQ(closest_on_triangle({1, -1, 3}, t).weights, glm::dvec3(0.5, 0.5, 0));
  EXPECT_EQ(closest_on_triangle({2, 2, 1}, t).weights, glm::dvec3(0, 0.5, 0.5));
  EXPECT_EQ(closest_on_triangle({-1, 1, 0}, t).weights, glm::dvec3(0.5, 0, 0.5));
  EXPECT_EQ(closest_on_triangle({-1, -1, 0}, t).weights, glm::dvec3(1, 0, 0));
  EXPECT_EQ(closest_on_triangle({5, -1, 0}, t).weights, glm::dvec3(0, 1, 0));
  EXPECT_EQ(closest_on_triangle({-1, 5, 0}, t).weights, glm::dvec3(0, 0, 1));
}

/// Small triangles in a unit cube, every kind of degenerate one among them, some of them twice.
TriMesh random_mesh(unsigned seed, int count, const glm::dvec3& origin) {
  RandomPoints random(seed);
  TriMesh mesh;
  mesh.origin = origin;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 centre = random.point();
    std::array<glm::dvec3, 3> t;
    for (glm::dvec3& corner : t) corner = centre + random.point(0.05);
    if (i % 7 == 1) t[2] = 0.3 * t[0] + 0.7 * t[1];
    if (i % 7 == 2) t[2] = t[1];
    if (i % 7 == 3) t[1] = t[2] = t[0];
    if (i % 7 == 4) t[1] = t[0] + 30.0 * (t[1] - t[0]);
    const auto first = std::uint32_t(mesh.positions.size());
    for (const glm::dvec3& corner : t) mesh.positions.emplace_back(corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
    if (i % 11 == 0) mesh.triangles.push_back({first + 2, first, first + 1});
  }
  return mesh;
}

NearestPoint brute_force(const TriMesh& mesh, const glm::dvec3& p) {
  NearestPoint best{INFINITY, {}, {}, 0};
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    const TrianglePoint found = closest_on_triangle(
        p - mesh.origin, {mesh.positions[a], mesh.positions[b], mesh.positions[c]});
    const double distance = std::sqrt(found.squared_distance);
    if (distance < best.distance) best = {distance, found.point + mesh.origin, found.weights, i};
  }
  return best;
}

TEST(ClosestPoint, AgreesWithBruteForceNearAndFar) {
  for (const glm::dvec3& origin : {glm::dvec3(0), glm::dvec3(5e6, -3e6, 1e3)}) {
    const TriMesh mesh = random_mesh(7, 700, origin);
    const ClosestPoint surface(mesh);
    RandomPoints random(8);
    for (int i = 0; i < 2000; ++i) {
      const double reach = i % 4 == 0 ? 1000.0 : 1.5;
      glm::dvec3 p = origin + random.point(reach);
      if (i % 4 == 1) p = mesh.world(std::size_t(i) % mesh.positions.size());
      const NearestPoint expected = brute_force(mesh, p), found = surface.nearest(p);
      ASSERT_EQ(found.distance, expected.distance) << i;
      ASSERT_EQ(found.triangle, expected.triangle) << i;
      ASSERT_EQ(found.point, expected.point) << i;
      ASSERT_EQ(found.weights, expected.weights) << i;
    }
  }
}

TEST(ClosestPoint, ExactWhereTheTreesOwnPrecisionIsTooCoarse) {
  // A thousand from the mesh's origin, floats are 6e-5 apart: as much as these distances.
  RandomPoints random(9);
  const glm::dvec3 centre(1000, -1000, 1000);
  TriMesh mesh;
  for (std::uint32_t i = 0; i < 900; ++i) {
    mesh.positions.emplace_back(centre + random.point(0.002));
    if (i % 3 == 2) mesh.triangles.push_back({i - 2, i - 1, i});
  }
  const ClosestPoint surface(mesh);
  for (int i = 0; i < 3000; ++i) {
    const glm::dvec3 p = centre + random.point(0.003);
    const NearestPoint expected = brute_force(mesh, p), found = surface.nearest(p);
    ASSERT_EQ(found.distance, expected.distance) << i;
    ASSERT_EQ(found.triangle, expected.triangle) << i;
    ASSERT_EQ(surface.nearest(p, std::uint32_t(i) % 300).triangle, expected.triangle) << i;
  }
}

TEST(ClosestPoint, MeshesOfAnyScaleAndWithoutExtent) {
  for (const float scale : {1e-12f, 1.0f, 1e12f}) {
    TriMesh mesh;
    mesh.positions = {scale * glm::vec3(0, 0, 0), scale * glm::vec3(1, 0, 0),
                      scale * glm::vec3(0, 1, 0)};
    mesh.triangles = {{0, 1, 2}};
    EXPECT_NEAR(
        ClosestPoint(mesh).nearest(double(scale) * glm::dvec3(0.2, 0.2, 3)).distance / scale, 3,
        1e-6);
    EXPECT_EQ(ClosestPoint(mesh).nearest(glm::dvec3(0)).distance, 0);
    mesh.triangles = {{1, 1, 1}};
    EXPECT_NEAR(ClosestPoint(mesh).nearest(glm::dvec3(0)).distance / scale, 1, 1e-6);
  }
}

TEST(ClosestPoint, UnusableMeshesAreErrors) {
  EXPECT_THROW(ClosestPoint{TriMesh()}, Error);
  TriMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, NAN}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_THROW(ClosestPoint{mesh}, Error);
}

}  // namespace
}  // namespace photohull
