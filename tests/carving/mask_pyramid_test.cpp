#include "carving/mask_pyramid.h"

#include <gtest/gtest.h>

#include <bit>

#include "support/silhouettes.h"

namespace photohull::carving {
namespace {

constexpr int kBlock = MaskPyramid::kBlock;

/// Compares every cell of every level with the pixels it stands for.
void expect_equals_brute_force(const Mask& mask, const MaskPyramid& pyramid) {
  for (int level = 0; level < int(pyramid.levels.size()); ++level) {
    const int width = std::max(pyramid.width >> level, 1);
    const int height = std::max(pyramid.height >> level, 1);
    ASSERT_EQ(pyramid.levels[level].size(), std::size_t(width) * height * 2);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        int least = 255, greatest = 0;
        const int edge = kBlock << level;
        for (int py = y * edge; py < std::min((y + 1) * edge, mask.height); ++py)
          for (int px = x * edge; px < std::min((x + 1) * edge, mask.width); ++px) {
            least = std::min(least, int(mask.coverage[std::size_t(py) * mask.width + px]));
            greatest = std::max(greatest, int(mask.coverage[std::size_t(py) * mask.width + px]));
          }
        const std::uint8_t* cell = &pyramid.levels[level][(std::size_t(y) * width + x) * 2];
        ASSERT_EQ(cell[0], least) << "level " << level << " cell " << x << ", " << y;
        ASSERT_EQ(cell[1], greatest) << "level " << level << " cell " << x << ", " << y;
      }
  }
}

struct Size {
  int width, height, array_width, array_height;
};

class MaskPyramidTest : public ::testing::TestWithParam<Size> {};

TEST_P(MaskPyramidTest, EqualsBruteForce) {
  const Size s = GetParam();
  test::Rng rng(1);
  Mask mask{s.width, s.height, {}};
  for (int i = 0; i < s.width * s.height; ++i)
    mask.coverage.push_back(std::uint8_t(test::uniform(rng, 1, 255)));
  const MaskPyramid pyramid = build_mask_pyramid(mask, s.array_width, s.array_height);
  EXPECT_TRUE(std::has_single_bit(unsigned(pyramid.width)));
  EXPECT_TRUE(std::has_single_bit(unsigned(pyramid.height)));
  EXPECT_GE(pyramid.width * kBlock, s.array_width);
  EXPECT_GE(pyramid.height * kBlock, s.array_height);
  EXPECT_EQ(pyramid.levels.back().size(), 2u);
  expect_equals_brute_force(mask, pyramid);
}

INSTANTIATE_TEST_SUITE_P(Sizes, MaskPyramidTest,
                         ::testing::Values(Size{64, 32, 64, 32}, Size{61, 37, 61, 37},
                                           Size{13, 50, 64, 51}, Size{1, 1, 1, 1},
                                           Size{1, 100, 1, 100}, Size{5, 4, 5, 4},
                                           Size{3, 3, 200, 7}));

TEST(MaskPyramid, KeepsASingleDifferentPixel) {
  test::Rng rng(2);
  for (int i = 0; i < 50; ++i) {
    Mask mask{37, 29, std::vector<std::uint8_t>(37 * 29, 0)};
    mask.coverage[std::size_t(test::uniform(rng, 0, 37 * 29))] = 200;
    const MaskPyramid pyramid = build_mask_pyramid(mask, 37, 29);
    for (const auto& level : pyramid.levels) {
      int with = 0;
      for (std::size_t cell = 1; cell < level.size(); cell += 2) with += level[cell] == 200;
      EXPECT_EQ(with, 1);
    }
  }
}

TEST(MaskPyramidDeathTest, TheMaskMustFitTheArray) {
  const Mask mask{8, 8, std::vector<std::uint8_t>(64)};
  EXPECT_DEATH(build_mask_pyramid(mask, 7, 8), "check failed");
}

}  // namespace
}  // namespace photohull::carving
