#include "core/half_float.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>

namespace photohull {
namespace {

constexpr std::uint16_t kSign = 0x8000, kLargest = 0x7bff, kInfinite = 0x7c00;

TEST(HalfFloat, IsTheNearestAndOfTwoTheEvenOne) {
  for (std::uint16_t h = 0; h < kLargest; ++h) {
    const std::uint16_t next = std::uint16_t(h + 1), even = h % 2 == 0 ? h : next;
    const float low = glm::unpackHalf1x16(h), high = glm::unpackHalf1x16(next);
    const float middle = 0.5f * (low + high);
    ASSERT_EQ(half_float(low), h);
    ASSERT_EQ(half_float(-low), h | kSign);
    ASSERT_EQ(half_float(std::nextafter(middle, low)), h);
    ASSERT_EQ(half_float(middle), even);
    ASSERT_EQ(half_float(-middle), even | kSign);
    ASSERT_EQ(half_float(std::nextafter(middle, high)), next);
  }
}

TEST(HalfFloat, IsInfiniteBeyondTheLargest) {
  EXPECT_EQ(half_float(65504), kLargest);
  EXPECT_EQ(half_float(std::nextafter(65520.0f, 0.0f)), kLargest);
  EXPECT_EQ(half_float(65520), kInfinite);
  EXPECT_EQ(half_float(-1e30f), kInfinite | kSign);
}

}  // namespace
}  // namespace photohull
