#include "assess/silhouette_check.h"

#include <gtest/gtest.h>

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
