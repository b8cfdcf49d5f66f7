#include "assess/silhouette_check.h"

#include <gtest/gtest.h>

#include "core/clip_ray.h"
#include "masks/silhouette.h"
#include "meshes.h"
#include "support/silhouettes.h"

namespace photohull::assess {
namespace {

const Box kBox{{-1, -1, -1}, {1, 1, 1}};
const std::vector<Camera> kCameras = test::cameras_around({0, 0, 0}, 5, 3, 180, 120, 90);

std::vector<SilhouetteFit> check(const TriMesh& mesh, double radius, double tolerance = 1.5) {
  std::vector<test::Outline> outlines;
  std::vector<CheckedSilhouette> silhouettes;
  for (const Camera& camera : kCameras)
    outlines.push_back(test::sphere_outline(camera, {0, 0, 0}, radius));
  for (const test::Outline& o : outlines) silhouettes.push_back({&o.distance, &o.distance});
  silhouettes.back() = {};
  return check_silhouettes(RayScene(mesh), kBox, kCameras, silhouettes, tolerance);
}

TEST(SilhouetteCheck, TheRightSurfaceFillsTheSilhouettes) {
  const auto fits = check(test::sphere_mesh({0, 0, 0}, 0.7, 60), 0.7);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(fits[i].missed, 0);
    EXPECT_EQ(fits[i].excess, 0);
    EXPECT_GT(fits[i].foreground, 1000);
  }
  EXPECT_EQ(fits[2].foreground, 0);  // nothing is known of it
}

TEST(SilhouetteCheck, SharesAreThoseOfTheAreas) {
  for (const SilhouetteFit& fit : {check(test::sphere_mesh({0, 0, 0}, 0.5, 60), 0.7, 0)[0]})
    EXPECT_NEAR(fit.missed, 1 - 0.25 / 0.49, 0.03);
  for (const SilhouetteFit& fit : {check(test::sphere_mesh({0, 0, 0}, 0.9, 60), 0.7, 0)[0]}) {
    EXPECT_NEAR(fit.excess, 1 - 0.49 / 0.81, 0.03);
    EXPECT_EQ(fit.missed, 0);
  }
}

TEST(SilhouetteCheck, WhatTheBoxCutsOffIsBeyondIt) {
  const test::Outline outline = test::sphere_outline(kCameras[0], {0, 0, 0}, 0.7);
  const std::vector<CheckedSilhouette> one{{&outline.distance, &outline.distance}};
  const RayScene rays(test::sphere_mesh({0, 0, 0}, 0.7, 60));
  const auto beyond = [&](const Box& box) {
    return check_silhouettes(rays, box, std::span(kCameras).first(1), one, 1.5)[0].beyond_box;
  };
  EXPECT_EQ(beyond(kBox), 0);
  const Box half{{-1, -1, -1}, {1, 1, -0.2}};
  double foreground = 0, cut = 0;
  for (int y = 0; y < outline.distance.height; ++y)
    for (int x = 0; x < outline.distance.width; ++x) {
      if (outline.distance.pixels[std::size_t(y * outline.distance.width + x)] > -1.5f) continue;
      foreground += 1;
      cut += !clip_ray(half, kCameras[0].center(), kCameras[0].ray({x, y}));
    }
  EXPECT_GT(cut, 0.05 * foreground);
  EXPECT_NEAR(beyond(half), cut / foreground, 0.01);
}

// Petioles are wider than lines, and narrower than twice the tolerance of coarse voxels.
TEST(SilhouetteCheck, PartsNarrowerThanTheToleranceAreMissedByTheirWidth) {
  const Camera& camera = kCameras[0];
  Mask mask{120, 90, std::vector<std::uint8_t>(120 * 90, 0)};
  for (int y = 20; y < 70; ++y)
    for (const int x : {40, 80})
      for (int k = 0; k < 4; ++k) mask.coverage[std::size_t(y * 120 + x + k)] = 255;
  const SilhouetteDistance distance = silhouette_distance(mask);
  TriMesh plate;  // over the one on the left
  for (const glm::dvec2& p : {glm::dvec2(30, 10), {55, 10}, {55, 80}, {30, 80}})
    plate.positions.emplace_back(camera.center() + 5.0 * camera.ray(p));
  plate.triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::vector<CheckedSilhouette> one{{&distance, &distance}};
  const SilhouetteFit fit =
      check_silhouettes(RayScene(plate), kBox, std::span(kCameras).first(1), one, 5)[0];
  EXPECT_NEAR(fit.missed, 0.5, 0.02);
  EXPECT_NEAR(fit.missed_width, 4, 1);
}

// A lattice of the whole picture would have two or three places in this foreground: one that falls
// into a gap by chance would be a third of it.
TEST(SilhouetteCheck, SmallForegroundIsLookedAtPixelByPixel) {
  const std::vector<Camera> cameras = test::cameras_around({0, 0, 0}, 5, 3, 1200, 900, 900);
  std::vector<test::Outline> outlines;
  for (const Camera& camera : cameras)
    outlines.push_back(test::sphere_outline(camera, {0, 0, 0}, 0.06));
  std::vector<CheckedSilhouette> silhouettes;
  for (const test::Outline& o : outlines) silhouettes.push_back({&o.distance, &o.distance});
  const TriMesh smaller = test::sphere_mesh({0, 0, 0}, 0.05, 60);
  for (const SilhouetteFit& fit :
       check_silhouettes(RayScene(smaller), kBox, cameras, silhouettes, 0)) {
    EXPECT_GT(fit.foreground, 300);
    EXPECT_NEAR(fit.missed, 1 - 25.0 / 36, 0.03);
  }
}

}  // namespace
}  // namespace photohull::assess
