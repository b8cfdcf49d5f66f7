#include "assess/surface_probes.h"

#include <gtest/gtest.h>

#include "meshes.h"
#include "support/cameras.h"

namespace photohull::assess {
namespace {

TriMesh certain(TriMesh mesh) {
  mesh.confidence.assign(mesh.positions.size(), 0.5f);
  return mesh;
}

TEST(SurfaceProbes, AreSeenByTheViewsThatTheyFace) {
  const TriMesh mesh = certain(test::sphere_mesh({0, 0, 0}, 1, 60));
  const std::vector<Camera> cameras = test::cameras_around({0, 0, 0}, 6, 12, 200, 160, 160);
  const auto probes = probe_surface(mesh, RayScene(mesh), cameras, 500, 0.02);
  ASSERT_EQ(probes.size(), 500u);
  for (const SurfaceProbe& p : probes) {
    EXPECT_NEAR(glm::length(p.point), 1, 0.01);
    EXPECT_GT(glm::dot(p.normal, p.point), 0.99);
    EXPECT_FLOAT_EQ(p.confidence, 0.5f);
    double last = 1;
    for (std::size_t v = 0; v < cameras.size(); ++v) {
      const double cosine = glm::dot(glm::normalize(cameras[v].center() - p.point), p.normal);
      const bool seen = std::find(p.views.begin(), p.views.end(), int(v)) != p.views.end();
      if (std::abs(cosine - 0.25) > 0.05) {
        EXPECT_EQ(seen, cosine > 0.25) << cosine;
      }
    }
    for (const int v : p.views) {
      const double cosine = glm::dot(glm::normalize(cameras[v].center() - p.point), p.normal);
      EXPECT_LE(cosine, last + 0.02);
      last = cosine;
    }
  }
}

TEST(SurfaceProbes, WhatStandsBeforeThemHides) {
  // A small sphere between the camera and the large one's middle.
  TriMesh mesh = test::sphere_mesh({0, 0, 0}, 1, 40);
  const TriMesh small = test::sphere_mesh({0, 0, 2}, 0.3, 40);
  const auto first = std::uint32_t(mesh.positions.size());
  for (std::size_t i = 0; i < small.positions.size(); ++i)
    mesh.positions.emplace_back(small.world(i));
  for (auto t : small.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  mesh = certain(mesh);
  const Camera camera = test::look_at({0, 0, 6}, {0, 0, 0}, 200, 200, 200, {0, -1, 0});
  int hidden = 0;
  for (const SurfaceProbe& p :
       probe_surface(mesh, RayScene(mesh), std::vector{camera}, 2000, 0.02)) {
    const double across = std::hypot(p.point.x, p.point.y);
    if (p.point.z < 0.8 || p.point.z > 1.2 || across > 0.3) continue;
    EXPECT_TRUE(p.views.empty());
    ++hidden;
  }
  EXPECT_GT(hidden, 5);
}

}  // namespace
}  // namespace photohull::assess
