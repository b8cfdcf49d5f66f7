#include "render/photograph.h"

#include <gtest/gtest.h>

#include "support/ray_cast.h"

namespace photohull::render {
namespace {

TEST(Photograph, EncodingInvertsDecoding) {
  for (int byte = 0; byte < 256; ++byte)
    EXPECT_EQ(encode_srgb(decode_srgb(std::uint8_t(byte))), byte);
  EXPECT_EQ(encode_srgb(-1), 0);
  EXPECT_EQ(encode_srgb(7), 255);
}

TEST(Photograph, FullScaleKeepsThePixels) {
  test::Rng rng(2);
  const ColourImage image = test::random_image(rng, 9, 7);
  const RgbImage cut = cut_photograph(image, 1.5, 2.5, 1, 4, 3);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x)
      for (int c = 0; c < 3; ++c)
        EXPECT_EQ(cut.rgb[3 * (4 * y + x) + c], image.bytes[4 * (9 * (y + 3) + x + 2) + c]);
}

TEST(Photograph, HalfScaleAveragesLight) {
  test::Rng rng(3);
  const ColourImage image = test::random_image(rng, 8, 6);
  const RgbImage cut = cut_photograph(image, -0.5, -0.5, 0.5, 4, 3);
  const glm::vec4 sum =
      image.linear(2, 2) + image.linear(3, 2) + image.linear(2, 3) + image.linear(3, 3);
  EXPECT_NEAR(cut.rgb[3 * (4 + 1)], 255 * srgb_from_linear(sum.r / 4), 1);
}

TEST(Photograph, HalfFloatsLookTheSame) {
  test::Rng rng(4);
  const ColourImage image = test::random_image(rng, 8, 6);
  const RgbImage bytes = cut_photograph(image, -0.5, -0.5, 1.7, 13, 10);
  const RgbImage halves = cut_photograph(test::to_half(image), -0.5, -0.5, 1.7, 13, 10);
  for (std::size_t i = 0; i < bytes.rgb.size(); ++i) EXPECT_NEAR(bytes.rgb[i], halves.rgb[i], 1);
}

}  // namespace
}  // namespace photohull::render
