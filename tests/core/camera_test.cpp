#include "core/camera.h"

#include <gtest/gtest.h>

#include "support/cameras.h"

namespace photohull {
namespace {

const Box kBox{{-1, -2, -3}, {2, 2, 1}};

TEST(Camera, RayMeetsThePointThatProjectsThere) {
  test::Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const Camera camera = test::random_camera(rng, kBox, 640, 480);
    const glm::dvec3 point = test::uniform_in(rng, kBox);
    const auto pixel = camera.project(point);
    ASSERT_TRUE(pixel);
    const glm::dvec3 ray = camera.ray(*pixel);
    EXPECT_NEAR(glm::length(ray), 1, 1e-12);
    const glm::dvec3 to_point = point - camera.center();
    EXPECT_NEAR(glm::length(glm::cross(ray, to_point)), 0, 1e-9);
    EXPECT_GT(glm::dot(ray, to_point), 0);
  }
}

TEST(Camera, ProjectionMatrixAgreesWithProject) {
  test::Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const Camera camera = test::random_camera(rng, kBox, 640, 480);
    const glm::dvec3 point = test::uniform_in(rng, kBox);
    const glm::dvec3 stq = camera.projection() * glm::dvec4(point, 1);
    const auto pixel = camera.project(point);
    ASSERT_TRUE(pixel);
    EXPECT_NEAR(stq.x / stq.z, pixel->x, 1e-9);
    EXPECT_NEAR(stq.y / stq.z, pixel->y, 1e-9);
    EXPECT_NEAR(stq.z, camera.to_camera(point).z, 1e-9);
  }
}

TEST(Camera, CenterMapsToTheOriginAndForwardToTheAxis) {
  test::Rng rng(3);
  const Camera camera = test::random_camera(rng, kBox, 64, 48);
  EXPECT_NEAR(glm::length(camera.to_camera(camera.center())), 0, 1e-12);
  const glm::dvec3 ahead = camera.to_camera(camera.center() + 2.5 * camera.forward());
  EXPECT_NEAR(glm::distance(ahead, glm::dvec3(0, 0, 2.5)), 0, 1e-12);
}

TEST(Camera, PixelsFollowTheStatedFormula) {
  Camera camera;
  camera.intrinsics = {100, 80, 50, 60, 7, 40, 30};
  const auto pixel = camera.project({1, 2, 4});
  ASSERT_TRUE(pixel);
  EXPECT_DOUBLE_EQ(pixel->x, (50 * 1 + 7 * 2) / 4.0 + 40);
  EXPECT_DOUBLE_EQ(pixel->y, 60 * 2 / 4.0 + 30);
}

TEST(Camera, NothingBehindOrBesideTheCentreIsProjected) {
  Camera camera;
  camera.intrinsics = {100, 80, 50, 50, 0, 50, 40};
  EXPECT_FALSE(camera.project({0, 0, -1}));
  EXPECT_FALSE(camera.project({1, 0, 0}));
  EXPECT_FALSE(camera.project({0, 0, 0}));
  EXPECT_TRUE(camera.project({0, 0, 1e-9}));
}

TEST(Camera, TheImageReachesToTheOuterEdgesOfItsPixels) {
  Camera camera;
  camera.intrinsics = {100, 80, 50, 50, 0, 50, 40};
  EXPECT_TRUE(camera.on_image({-0.5, -0.5}));
  EXPECT_TRUE(camera.on_image({99.5, 79.5}));
  EXPECT_FALSE(camera.on_image({-0.51, 10}));
  EXPECT_FALSE(camera.on_image({10, 79.51}));
  EXPECT_FALSE(camera.on_image({99.51, 10}));
}

}  // namespace
}  // namespace photohull
