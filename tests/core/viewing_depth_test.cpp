#include "core/viewing_depth.h"

#include <gtest/gtest.h>

#include "support/cameras.h"

namespace photohull {
namespace {

const Box kBox{{-1, -1, -1}, {1, 1, 1}};

double depth_of(const Camera& camera) {
  return viewing_depth(camera.projection(), camera.center(), camera.intrinsics.width,
                       camera.intrinsics.height, kBox);
}

TEST(ViewingDepth, IsTheMiddlesForCamerasOutsideThatSeeIt) {
  EXPECT_NEAR(depth_of(test::look_at({5, 0, 0}, {0, 0, 0}, 200, 160, 120)), 5, 1e-12);
  EXPECT_NEAR(depth_of(test::look_at({5, 0, 0}, {0, 0.5, 0.2}, 200, 160, 120)), 5, 0.1);
}

// From the middle of a cube that is two wide all walls are one away, and corners more.
TEST(ViewingDepth, IsThatOfTheWallsForCamerasWithin) {
  for (const glm::dvec3& target : {glm::dvec3(1, 0, 0), {0, -1, 0}, {1, 1, 0.01}}) {
    const double depth = depth_of(test::look_at({0.001, 0, 0}, target, 200, 160, 120));
    EXPECT_GT(depth, 0.9);
    EXPECT_LT(depth, 1.5);
  }
  // Whose back is at the wall sees the other one.
  EXPECT_NEAR(depth_of(test::look_at({-0.95, 0, 0}, {0, 0, 0}, 400, 160, 120)), 1.95, 0.05);
}

TEST(ViewingDepth, IsTheBoxesWhereItsMiddleIsNotOnTheImage) {
  const double depth = depth_of(test::look_at({3, 0, 0}, {0, 0.9, 0}, 800, 160, 120));
  EXPECT_GT(depth, 3);
  EXPECT_LT(depth, 4.5);
}

TEST(ViewingDepth, IsNotPositiveForCamerasThatLookAway) {
  EXPECT_LE(depth_of(test::look_at({5, 0, 0}, {9, 0, 0}, 200, 160, 120)), 0);
}

}  // namespace
}  // namespace photohull
