#include "raycast/ray_scene.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <random>

#include "core/error.h"
#include "raycast/closest_point.h"

namespace photohull {
namespace {

/// Triangles thrown into a box, far from the world's origin.
TriMesh triangle_soup(int count) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<float> place(-1, 1), edge(-0.3f, 0.3f);
  TriMesh mesh;
  mesh.origin = {1000, -500, 250};
  for (int i = 0; i < count; ++i) {
    const glm::vec3 p(place(engine), place(engine), place(engine));
    const auto first = std::uint32_t(mesh.positions.size());
    for (int k = 0; k < 3; ++k)
      mesh.positions.push_back(p + glm::vec3(edge(engine), edge(engine), edge(engine)));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Moller and Trumbore, in double precision, over all triangles.
Hit brute_force(const TriMesh& mesh, const Ray& ray) {
  Hit best;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::dvec3 a = mesh.world(mesh.triangles[i][0]);
    const glm::dvec3 ab = mesh.world(mesh.triangles[i][1]) - a;
    const glm::dvec3 ac = mesh.world(mesh.triangles[i][2]) - a;
    const glm::dvec3 p = cross(ray.direction, ac), s = ray.origin - a, q = cross(s, ab);
    const double det = dot(ab, p), u = dot(s, p) / det, v = dot(ray.direction, q) / det;
    const double t = dot(ac, q) / det;
    if (u < 0 || v < 0 || u + v > 1 || t < ray.tnear || t > ray.tfar) continue;
    if (!best || t < best.t) best = {i, u, v, t};
  }
  return best;
}

std::vector<Ray> random_rays(const TriMesh& mesh, int count) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> place(-2, 2);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 from(place(engine), place(engine), place(engine));
    const glm::dvec3 to(place(engine), place(engine), place(engine));
    rays.push_back({mesh.origin + from, to - from, 0.1, i % 2 ? 0.9 : 1e30});
  }
  return rays;
}

TEST(RayScene, AgreesWithTestingEveryTriangle) {
  const TriMesh mesh = triangle_soup(300);
  const RayScene scene(mesh);
  const std::vector<Ray> rays = random_rays(mesh, 1003);  // no multiple of a packet
  std::vector<Hit> hits(rays.size());
  std::vector<std::uint8_t> blocked(rays.size());
  scene.closest(rays, hits);
  scene.occluded(rays, blocked);
  int found = 0, different = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit expected = brute_force(mesh, rays[i]);
    const auto one = scene.closest(rays[i].origin, rays[i].direction, 0.1, rays[i].tfar);
    found += bool(expected);
    // Rounding may decide at an edge; never in more than a few of a thousand rays.
    different += expected.triangle != hits[i].triangle;
    ASSERT_EQ(one.has_value(), bool(hits[i]));
    EXPECT_EQ(blocked[i] != 0, bool(hits[i]));
    EXPECT_EQ(scene.occluded(rays[i].origin, rays[i].direction, 0.1, rays[i].tfar),
              one.has_value());
    if (!one) continue;
    EXPECT_EQ(one->triangle, hits[i].triangle);
    if (expected.triangle != hits[i].triangle) continue;
    EXPECT_NEAR(hits[i].t, expected.t, 1e-5);
    EXPECT_NEAR(hits[i].u, expected.u, 1e-3);
    EXPECT_NEAR(hits[i].v, expected.v, 1e-3);
  }
  EXPECT_GT(found, 300);
  EXPECT_LE(different, 5);
}

TEST(RayScene, NothingSlipsThroughSharedEdges) {
  TriMesh plane;
  constexpr int kSide = 20;
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x) plane.positions.push_back({x * 0.1f, y * 0.1f, 0});
  for (std::uint32_t y = 0; y < kSide; ++y)
    for (std::uint32_t x = 0; x < kSide; ++x) {
      const std::uint32_t i = y * (kSide + 1) + x;
      plane.triangles.push_back({i, i + 1, i + kSide + 2});
      plane.triangles.push_back({i, i + kSide + 2, i + kSide + 1});
    }
  const RayScene scene(plane);
  for (const glm::vec3& p : plane.positions) {
    if (p.x < 0.05f || p.y < 0.05f || p.x > 1.95f || p.y > 1.95f) continue;
    const glm::dvec3 eye(0.3, 0.7, 2);
    EXPECT_TRUE(scene.occluded(eye, glm::dvec3(p) - eye)) << p.x << " " << p.y;
    EXPECT_NEAR(scene.closest(eye, glm::dvec3(p) - eye)->t, 1.0, 1e-6);
  }
}

TEST(RayScene, RefusesWhatIsNoMesh) {
  EXPECT_THROW(RayScene{TriMesh{}}, Error);
  TriMesh mesh = triangle_soup(2);
  mesh.positions[4].y = NAN;
  try {
    const RayScene scene(mesh);
    FAIL() << "accepted";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("vertex 4"), std::string::npos) << e.what();
  }
}

// Embree's own tasks would be cancelled with those around them, and leave scenes without a tree.
TEST(RayScene, IsBuiltWhileATaskBesideItFails) {
  constexpr std::size_t kTasks = 8;
  const TriMesh mesh = triangle_soup(12);
  const Ray ray{mesh.origin + glm::dvec3(5), glm::dvec3(-1), 0, 1e30};
  const bool expected = RayScene(mesh).occluded(ray.origin, ray.direction, 0, 1e30);
  for (std::size_t i = 0; i < 200; ++i)
    EXPECT_THROW(
        tbb::parallel_for(std::size_t(0), kTasks,
                          [&](std::size_t task) {
                            if (task == i % kTasks) throw Error("another task's");
                            EXPECT_EQ(RayScene(mesh).occluded(ray.origin, ray.direction, 0, 1e30),
                                      expected);
                            EXPECT_LT(ClosestPoint(mesh).nearest(mesh.world(0)).distance, 1e-6);
                          }),
        Error);
}

/// Embree's devices can limit all of the process's TBB as long as they live.
TEST(RayScene, LeavesTheProcessItsThreads) {
  const auto allowed = [] {
    return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  };
  const std::size_t before = allowed();
  const TriMesh mesh = triangle_soup(100);
  const RayScene rays(mesh);
  EXPECT_EQ(allowed(), before);
  const ClosestPoint near(mesh);
  EXPECT_EQ(allowed(), before);
}

}  // namespace
}  // namespace photohull
