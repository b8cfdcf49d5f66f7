#include "texture/pack.h"

#include <gtest/gtest.h>

#include <bit>

#include "support/cameras.h"

namespace photohull::texture {
namespace {

std::vector<glm::ivec2> random_sizes(int count, int most) {
  test::Rng rng(7);
  std::vector<glm::ivec2> sizes;
  for (int i = 0; i < count; ++i)
    sizes.emplace_back(int(test::uniform(rng, 1, most)), int(test::uniform(rng, 1, most)));
  return sizes;
}

/// Fails where two rectangles share a texel, or one leaves its page.
void expect_apart(const std::vector<glm::ivec2>& sizes, const Packed& packed) {
  std::vector<std::vector<std::uint8_t>> pages(
      packed.pages, std::vector<std::uint8_t>(std::size_t(packed.page.x) * packed.page.y, 0));
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    ASSERT_LT(packed.on[i], packed.pages);
    const glm::ivec2 end = packed.place[i] + sizes[i];
    ASSERT_TRUE(glm::all(glm::greaterThanEqual(packed.place[i], glm::ivec2(0))));
    ASSERT_TRUE(glm::all(glm::lessThanEqual(end, packed.page)));
    for (int y = packed.place[i].y; y < end.y; ++y)
      for (int x = packed.place[i].x; x < end.x; ++x)
        ASSERT_EQ(pages[packed.on[i]][std::size_t(y) * packed.page.x + std::size_t(x)]++, 0);
  }
}

TEST(Pack, OnePageAsSmallAsHoldsAll) {
  const std::vector<glm::ivec2> sizes = random_sizes(400, 40);
  const Packed packed = pack(sizes, 4096);
  expect_apart(sizes, packed);
  EXPECT_EQ(packed.pages, 1u);
  EXPECT_TRUE(std::has_single_bit(unsigned(packed.page.x)));
  EXPECT_TRUE(std::has_single_bit(unsigned(packed.page.y)));
  double area = 0;
  for (const glm::ivec2& size : sizes) area += double(size.x) * size.y;
  EXPECT_GT(area, 0.4 * packed.page.x * packed.page.y);
}

TEST(Pack, AsManyPagesAsAreNeeded) {
  const std::vector<glm::ivec2> sizes = random_sizes(600, 60);
  const Packed packed = pack(sizes, 256);
  expect_apart(sizes, packed);
  EXPECT_GT(packed.pages, 1u);
  EXPECT_EQ(packed.page, glm::ivec2(256));
}

TEST(Pack, ARectangleAsLargeAsThePageFits) {
  const std::vector<glm::ivec2> sizes = {{128, 128}, {1, 1}};
  const Packed packed = pack(sizes, 128);
  expect_apart(sizes, packed);
  EXPECT_EQ(packed.pages, 2u);
}

}  // namespace
}  // namespace photohull::texture
