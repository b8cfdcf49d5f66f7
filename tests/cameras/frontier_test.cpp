#include "cameras/frontier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace photohull {
namespace {

using glm::dvec2;

std::vector<dvec2> corners_of_pixel(int x, int y) {
  constexpr int kWidth = 27, kHeight = 5;
  Mask mask{kWidth, kHeight, std::vector<std::uint8_t>(kWidth * kHeight, 0)};
  mask.coverage[std::size_t(y * kWidth + x)] = 255;
  return outline_of(mask, {}).corners;
}

// Runs of pixels without a contour are passed over: none of them may hide one.
TEST(OutlineOf, APixelHasItsFourSidesWhereverItIs) {
  for (int y = 1; y < 4; ++y)
    for (int x = 1; x < 26; ++x)
      EXPECT_THAT(corners_of_pixel(x, y),
                  testing::UnorderedElementsAre(dvec2(x - 0.5, y), dvec2(x + 0.5, y),
                                                dvec2(x, y - 0.5), dvec2(x, y + 0.5)))
          << x << " " << y;
}

TEST(OutlineOf, ForegroundOnTheFrameIsPartOfIt) {
  for (int x = 0; x < 27; ++x) {
    EXPECT_THAT(corners_of_pixel(x, 0), testing::Contains(dvec2(x, 0.5))) << x;
    EXPECT_THAT(corners_of_pixel(x, 4), testing::Contains(dvec2(x, 3.5))) << x;
  }
}

TEST(OutlineOf, AFullMaskHasTheFramesCorners) {
  const Mask mask{20, 12, std::vector<std::uint8_t>(20 * 12, 255)};
  EXPECT_THAT(
      outline_of(mask, {}).corners,
      testing::UnorderedElementsAre(dvec2(0, 0), dvec2(19, 0), dvec2(19, 11), dvec2(0, 11)));
}

TEST(OutlineOf, LinesReachToTheirEdges) {
  const Mask mask{30, 30, std::vector<std::uint8_t>(900, 0)};
  const std::vector<LinePoint> lines = {{10, 5, 1, 0, 0.6f}, {10, 20, 1, 0, 0.6f}};
  const std::vector<dvec2> corners = outline_of(mask, lines).corners;
  ASSERT_EQ(corners.size(), 4u);
  for (const dvec2& c : corners) EXPECT_NEAR(std::abs(c.x - 10), 0.3, 1e-6);
}

}  // namespace
}  // namespace photohull
