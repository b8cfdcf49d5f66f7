#include "core/image.h"

#include <gtest/gtest.h>

#include "support/ray_cast.h"

namespace photohull {
namespace {

TEST(Srgb, MatchesTheStandardsEndsAndJoint) {
  EXPECT_EQ(linear_from_srgb(0), 0);
  EXPECT_NEAR(linear_from_srgb(1), 1, 1e-12);
  EXPECT_NEAR(linear_from_srgb(0.04045), 0.04045 / 12.92, 1e-12);
  // The standard's rounded constants leave a step of under 1e-7 at the joint.
  EXPECT_NEAR(linear_from_srgb(0.04045 + 1e-9), linear_from_srgb(0.04045), 1e-7);
  EXPECT_NEAR(linear_from_srgb(0.5), 0.214041, 1e-6);
}

TEST(Srgb, EncodingUndoesDecoding) {
  double last = -1;
  for (int i = 0; i <= 1000; ++i) {
    const double linear = linear_from_srgb(i / 1000.0);
    EXPECT_GT(linear, last);
    EXPECT_NEAR(srgb_from_linear(linear), i / 1000.0, 1e-6);
    last = linear;
  }
}

TEST(ColourImage, DecodesColourButNotAlpha) {
  ColourImage image;
  image.width = 2;
  image.height = 1;
  image.bytes = {0, 0, 0, 0, 255, 128, 0, 128};
  EXPECT_EQ(image.linear(0, 0), glm::vec4(0));
  const glm::vec4 pixel = image.linear(1, 0);
  EXPECT_FLOAT_EQ(pixel.r, 1);
  EXPECT_NEAR(pixel.g, linear_from_srgb(128 / 255.0), 1e-7);
  EXPECT_EQ(pixel.b, 0);
  EXPECT_FLOAT_EQ(pixel.a, 128 / 255.0f);
}

TEST(ColourImage, HalfFloatsKeepElevenBits) {
  test::Rng rng(4);
  const ColourImage bytes = test::random_image(rng, 7, 5);
  const ColourImage half = test::to_half(bytes);
  EXPECT_EQ(half.bytes.size(), half.bytes_per_pixel() * 35);
  for (int y = 0; y < 5; ++y)
    for (int x = 0; x < 7; ++x)
      for (int c = 0; c < 4; ++c) EXPECT_NEAR(half.linear(x, y)[c], bytes.linear(x, y)[c], 0x1p-11);
}

TEST(ColourImageDeathTest, ChecksTheIndex) {
  ColourImage image;
  image.width = image.height = 1;
  image.bytes.assign(4, 0);
  EXPECT_DEATH(image.linear(1, 0), "check failed");
}

}  // namespace
}  // namespace photohull
