#include "masks/outline_probe.h"

#include <gtest/gtest.h>

#include "masks/silhouette.h"
#include "support/silhouettes.h"

namespace photohull {
namespace {

using glm::dvec3;

class OutlineProbeTest : public testing::Test {
 protected:
  test::Rng rng_{3};
  const Camera camera_ = test::cameras_around(dvec3(0), 5, 3, 120, 90, 60)[1];
  const SilhouetteDistance distance_ = test::random_outline(rng_, 90, 60).distance;
  const OutlineProbe probe_{camera_, &distance_};
};

TEST_F(OutlineProbeTest, AsTheCameraProjectsAndTheDistanceIsInterpolated) {
  int seen = 0;
  for (int i = 0; i < 20000; ++i) {
    const dvec3 p = test::uniform_in(
        rng_, {dvec3(-8), dvec3(8)});  // many are behind the camera or off its image
    Appearance at;
    const auto pixel = camera_.project(p);
    ASSERT_EQ(probe_.sees(p, at), pixel && camera_.on_image(*pixel));
    if (!pixel || !camera_.on_image(*pixel)) continue;
    ++seen;
    EXPECT_NEAR(at.x, pixel->x, 1e-9);
    EXPECT_NEAR(at.y, pixel->y, 1e-9);
    EXPECT_NEAR(at.depth, camera_.to_camera(p).z, 1e-9);
    EXPECT_NEAR(probe_.distance(at), interpolated(distance_, *pixel), 1e-4);
  }
  EXPECT_GT(seen, 1000);
}

TEST_F(OutlineProbeTest, TheDistanceGoesOnBeyondTheOutermostCentres) {
  for (const double x : {-0.5, -0.2, 0.0, 44.3, 88.7, 89.0, 89.5})
    for (const double y : {-0.5, 0.0, 30.6, 59.0, 59.5})
      EXPECT_NEAR(probe_.distance({x, y, 1}), interpolated(distance_, {x, y}), 1e-6)
          << x << " " << y;
}

TEST_F(OutlineProbeTest, TheNearestPixelIsOnTheImage) {
  for (const auto& [x, y, column, line] :
       {std::array{-0.5, -0.5, 0., 0.}, std::array{3.4, 7.6, 3., 8.},
        std::array{89.5, 59.5, 89., 59.}}) {
    const std::size_t pixel = probe_.nearest_pixel({x, y, 1});
    EXPECT_EQ(pixel, std::size_t(line) * 90 + std::size_t(column));
    EXPECT_EQ(probe_.nearest_distance({x, y, 1}), double(distance_.pixels[pixel]));
  }
}

TEST_F(OutlineProbeTest, AViewWithoutOutlineStillSeesPoints) {
  const OutlineProbe none(camera_, nullptr);
  Appearance at;
  EXPECT_FALSE(none.has_outline());
  EXPECT_TRUE(probe_.has_outline());
  EXPECT_TRUE(none.sees(dvec3(0), at));
}

}  // namespace
}  // namespace photohull
