#include "calib/shrink.h"

#include <gtest/gtest.h>

namespace photohull {
namespace {

TEST(Shrink, CameraSeesTheSamePlacesOfTheFrame) {
  Camera camera;
  camera.intrinsics = {640, 480, 500, 510, 3, 330, 235};
  const Camera half = resized(camera, 320, 240);
  const glm::dvec3 point(0.3, -0.2, 2);
  const glm::dvec2 p = *camera.project(point), q = *half.project(point);
  // A pixel's middle is half a pixel from its edge, whatever its size.
  EXPECT_NEAR(q.x + 0.5, 0.5 * (p.x + 0.5), 1e-12);
  EXPECT_NEAR(q.y + 0.5, 0.5 * (p.y + 0.5), 1e-12);
  EXPECT_EQ(half.intrinsics.width, 320);
}

TEST(Shrink, PixelsAreMeansOfWhatTheyCover) {
  ColourImage image{4, 2, ColourImage::Encoding::kSrgb8, false, {}};
  for (int i = 0; i < 8; ++i)
    for (int c = 0; c < 4; ++c) image.bytes.push_back(std::uint8_t(10 * i + c));
  const ColourImage small = shrink(image, 2, 1);
  ASSERT_EQ(small.bytes.size(), 8u);
  for (int c = 0; c < 4; ++c) {
    EXPECT_EQ(small.bytes[std::size_t(c)], 25 + c);      // of 0, 10, 40, 50
    EXPECT_EQ(small.bytes[std::size_t(4 + c)], 45 + c);  // of 20, 30, 60, 70
  }
  const Mask mask = shrink(Mask{2, 2, {0, 255, 255, 255}}, 1, 1);
  EXPECT_EQ(mask.coverage, std::vector<std::uint8_t>{191});
}

TEST(Shrink, KeepsHalfFloats) {
  ColourImage image{2, 2, ColourImage::Encoding::kLinearHalf, false, {}};
  for (const std::uint16_t half : {0x3c00, 0x4000, 0x3c00, 0x4000})  // 1, 2, 1, 2
    for (int c = 0; c < 4; ++c)
      image.bytes.insert(image.bytes.end(), {std::uint8_t(half & 255), std::uint8_t(half >> 8)});
  EXPECT_FLOAT_EQ(shrink(image, 1, 1).linear(0, 0).g, 1.5f);
}

}  // namespace
}  // namespace photohull
