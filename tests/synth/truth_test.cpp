#include "synth/truth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "synth/place_cameras.h"

namespace photohull::synth {
namespace {

TEST(Truth, SamplesAreSpreadByArea) {
  const Spec spec = parse_spec(R"({"geometry": {"shape": "block"}})", "test", "");
  const Surface surface = make_surface(spec.geometry);
  const auto samples = sample_surface(surface, 20000, 1);
  int bottom = 0;
  for (const TruthSample& s : samples) bottom += s.position.z < 1e-9 && s.normal.z < -0.5f;
  // Bottom: 2 x 1.2 less the hole; the whole: planes, walls and the inside of the hole.
  const double r = 0.275, disc = M_PI * r * r, base = 2.4 - disc;
  const double whole =
      base + (1.2 - disc) + 1.2 + 2 * (1.3 + 0.65) + 1.2 * (1.3 + 0.65 + 0.65) + 2 * M_PI * r * 1.3;
  EXPECT_NEAR(bottom / 20000.0, base / whole, 2e-3);
}

TEST(Truth, ViewsOfABallAreThoseThatItFaces) {
  Spec spec = parse_spec(R"({"cameras": {"layout": "hemisphere", "count": 9, "lowest": -60,
      "highest": 90}})",
                         "test", "");
  spec.image.width = 96, spec.image.height = 72;
  const Surface surface = make_surface(spec.geometry);
  const auto cameras = place_cameras(spec, surface);
  auto samples = sample_surface(surface, 5000, 1);
  count_views(surface, cameras, samples);
  int different = 0, one_camera = 0;
  for (const TruthSample& s : samples) {
    int facing = 0;
    for (const LensCamera& lens : cameras)
      facing += dot(s.position, lens.camera.center() - s.position) > 0;
    different += facing != s.views;
  }
  // Facets turn a little from the ball's own normals: at the rim of each view only.
  EXPECT_LT(different, 9 * 5000 * 0.006);
  for (TruthSample& s : samples) s.views = 0;
  count_views(surface, {cameras[0]}, samples);
  for (const TruthSample& s : samples) one_camera += s.views;
  // A camera at distance d sees the share (1 - r / d) / 2 of a ball.
  const double d = length(cameras[0].camera.center());
  EXPECT_NEAR(one_camera / 5000.0, (1 - 1 / d) / 2, 0.01);
}

/// A square in the plane z, facing +z.
void add_square(TriMesh& mesh, float half, float z) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (const glm::vec2 p : {glm::vec2(-half, -half), {half, -half}, {half, half}, {-half, half}})
    mesh.positions.emplace_back(p, z);
  mesh.triangles.push_back({first, first + 1, first + 2});
  mesh.triangles.push_back({first, first + 2, first + 3});
}

TEST(Truth, WhatStandsBeforeHides) {
  TriMesh mesh;
  add_square(mesh, 2, 0);
  add_square(mesh, 0.5f, 1);
  const Surface surface = make_surface(mesh, "squares");
  LensCamera lens;  // at (0, 0, 4), looking down: the small square's shadow reaches 0.5 * 4 / 3
  lens.camera.cam_from_world.rotation = {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  lens.camera.cam_from_world.translation = {0, 0, 4};
  lens.camera.intrinsics = {100, 100, 80, 80, 0, 49.5, 49.5};  // sees |x| <= 2.5 at z = 0
  auto samples = sample_surface(surface, 4000, 1);
  count_views(surface, {lens}, samples);
  int hidden = 0;
  for (const TruthSample& s : samples) {
    const double reach = std::max(std::abs(s.position.x), std::abs(s.position.y));
    if (std::abs(reach - 2.0 / 3) < 1e-3) continue;
    const bool behind = s.position.z < 0.5 && reach < 2.0 / 3;
    EXPECT_EQ(s.views, behind ? 0 : 1);
    hidden += behind;
  }
  EXPECT_GT(hidden, 200);
  // Out of the frame, and from behind.
  lens.camera.intrinsics.fx = 400;
  for (TruthSample& s : samples) s.views = 0;
  count_views(surface, {lens}, samples);
  for (const TruthSample& s : samples)
    if (std::abs(s.position.x) > 0.51) {
      EXPECT_EQ(s.views, 0);
    }
  lens.camera.cam_from_world.rotation = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (TruthSample& s : samples) s.views = 0;
  count_views(surface, {lens}, samples);
  for (const TruthSample& s : samples) EXPECT_EQ(s.views, 0);
}

}  // namespace
}  // namespace photohull::synth
