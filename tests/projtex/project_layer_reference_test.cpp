// The reference against cases that can be worked out by hand.
#include "projtex/project_layer_reference.h"

#include <gtest/gtest.h>

#include "support/ray_cast.h"

namespace photohull::projtex::reference {
namespace {

constexpr int kSize = 16;

/// Looks along z at the plane z = 10, where one voxel is `scale` pixels; voxel (x, y, 10) lies at
/// pixel (scale x, scale y).
GridCamera frontal_camera(double scale) {
  GridCamera camera;
  camera.projection = glm::dmat4x3(glm::dvec3(10 * scale, 0, 0), glm::dvec3(0, 10 * scale, 0),
                                   glm::dvec3(0, 0, 1), glm::dvec3(0));
  camera.width = camera.height = kSize;
  return camera;
}

/// With the lambda of the square itself.
glm::dvec4 sample(const GridCamera& camera, const std::vector<LinearImage>& mips,
                  const PlaneSquare& square, int supersample, MipFilter filter) {
  return project_layer_sample(camera, mips, square, supersample,
                              mip_level(camera, square, supersample), filter);
}

PlaneSquare square_at(double x, double y) { return {{x, y, 10}, {1, 0, 0}, {0, 1, 0}}; }

ColourImage noise() {
  test::Rng rng(1);
  return test::random_image(rng, kSize, kSize);
}

TEST(ProjectLayerSample, IsThePixelWherePixelsAndVoxelsCoincide) {
  const ColourImage image = noise();
  const auto mips = mip_chain(image, {kSize, kSize});
  const glm::dvec4 value = sample(frontal_camera(1), mips, square_at(5, 7), 1, MipFilter::kNearest);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c] * value[c], image.linear(5, 7)[c], 1e-7);
  EXPECT_EQ(value.a, 1);
}

TEST(ProjectLayerSample, LargeVoxelsGiveTheMeanOfTheirPixels) {
  const ColourImage image = noise();
  const auto mips = mip_chain(image, {kSize, kSize});
  glm::dvec4 mean(0);
  for (int y = 4; y < 8; ++y)
    for (int x = 8; x < 12; ++x) mean += glm::dvec4(image.linear(x, y)) / 16.0;
  // Centre of the pixels 8..11 x 4..7, whose mean is one pixel of level 2.
  const PlaneSquare square = square_at(9.5 / 4, 5.5 / 4);
  EXPECT_DOUBLE_EQ(mip_level(frontal_camera(4), square, 1), 2);
  for (const MipFilter filter : {MipFilter::kNearest, MipFilter::kTrilinear}) {
    const glm::dvec4 value = sample(frontal_camera(4), mips, square, 1, filter);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c] * value[c], mean[c], 1e-12);
  }
  // 4 x 4 samples of level 0 are the same pixels.
  EXPECT_DOUBLE_EQ(mip_level(frontal_camera(4), square, 4), 0);
  const glm::dvec4 value = sample(frontal_camera(4), mips, square, 4, MipFilter::kNearest);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c] * value[c], mean[c], 1e-12);
}

TEST(ProjectLayerSample, TakesTheLevelThatIsAskedFor) {
  const auto mips = mip_chain(noise(), {kSize, kSize});
  const glm::dvec4 value = project_layer_sample(frontal_camera(1), mips, square_at(5.5, 7.5), 1, 1,
                                                MipFilter::kTrilinear);
  const glm::dvec4 expected = 0.25 * (mips[1].pixels[3 * 8 + 2] + mips[1].pixels[3 * 8 + 3] +
                                      mips[1].pixels[4 * 8 + 2] + mips[1].pixels[4 * 8 + 3]);
  EXPECT_NEAR(value.g * value.g, expected.g, 1e-12);
}

TEST(ProjectLayerSample, MarksWhatTheImageDoesNotShow) {
  const auto mips = mip_chain(noise(), {kSize, kSize});
  const GridCamera camera = frontal_camera(1);
  const auto alpha = [&](const PlaneSquare& square) {
    return sample(camera, mips, square, 1, MipFilter::kNearest).a;
  };
  EXPECT_EQ(alpha(square_at(-0.5, 3)), 1);
  EXPECT_EQ(alpha(square_at(-0.51, 3)), -1);
  EXPECT_EQ(alpha(square_at(3, kSize - 0.49)), -1);
  EXPECT_EQ(alpha({{3, 3, -10}, {1, 0, 0}, {0, 1, 0}}), -1);
  EXPECT_EQ(alpha({{3, 3, 0}, {1, 0, 0}, {0, 1, 0}}), -1);
}

TEST(MipLevel, FollowsTheLongestEdge) {
  const GridCamera camera = frontal_camera(2);
  EXPECT_NEAR(mip_level(camera, {{1, 1, 10}, {1, 0, 0}, {0, 4, 0}}, 1), 3, 1e-12);
  EXPECT_NEAR(mip_level(camera, {{1, 1, 20}, {1, 0, 0}, {0, 1, 0}}, 1), 0, 1e-12);
  EXPECT_EQ(mip_level(camera, {{1, 1, -10}, {9, 0, 0}, {0, 9, 0}}, 1), 0);
  // Along the ray the image does not move at all.
  EXPECT_NEAR(mip_level(camera, {{1, 1, 10}, {0.1, 0.1, 1}, {0, 0, 0}}, 1), 0, 1e-12);
}

TEST(MipChain, RepeatsTheBorderAndEndsInTheMean) {
  test::Rng rng(2);
  const ColourImage image = test::random_image(rng, 5, 3);
  const auto chain = mip_chain(image, {8, 4});
  ASSERT_EQ(chain.size(), 4u);
  EXPECT_EQ(chain[0].pixels[7], glm::dvec4(image.linear(4, 0)));
  EXPECT_EQ(chain[0].pixels[3 * 8 + 2], glm::dvec4(image.linear(2, 2)));
  EXPECT_EQ(chain[3].width * chain[3].height, 1);
  glm::dvec4 mean(0);
  for (const glm::dvec4& p : chain[0].pixels) mean += p / 32.0;
  EXPECT_LT(glm::distance(chain[3].pixels[0], mean), 1e-12);
}

}  // namespace
}  // namespace photohull::projtex::reference
