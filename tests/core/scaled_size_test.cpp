#include "core/scaled_size.h"

#include <gtest/gtest.h>

namespace photohull {
namespace {

TEST(IsScaledCopy, TakesWhatResizingMakes) {
  EXPECT_TRUE(is_scaled_copy(800, 600, 1600, 1200));
  EXPECT_TRUE(is_scaled_copy(3200, 2400, 1600, 1200));
  EXPECT_TRUE(is_scaled_copy(1600, 1067, 5472, 3648));  // 1066.67 rounded to the nearest,
  EXPECT_TRUE(is_scaled_copy(1600, 1066, 5472, 3648));  // and down
  EXPECT_TRUE(is_scaled_copy(801, 601, 1601, 1201));    // halves rounded up, as JPEG decoders do,
  EXPECT_TRUE(is_scaled_copy(800, 600, 1601, 1201));    // and down
  EXPECT_TRUE(is_scaled_copy(401, 301, 3201, 2401));
}

TEST(IsScaledCopy, RefusesWhatItCannotMake) {
  EXPECT_FALSE(is_scaled_copy(1600, 1200, 1600, 1200));
  EXPECT_FALSE(is_scaled_copy(1200, 1600, 1600, 1200));
  EXPECT_FALSE(is_scaled_copy(800, 602, 1600, 1200));
  EXPECT_FALSE(is_scaled_copy(802, 600, 1600, 1200));
  EXPECT_FALSE(is_scaled_copy(1590, 1190, 1600, 1200));  // ten columns and rows cut off
  EXPECT_FALSE(is_scaled_copy(1599, 1199, 1600, 1200));  // one of each: nobody can tell
  EXPECT_FALSE(is_scaled_copy(1920, 1080, 1920, 1088));
  EXPECT_FALSE(is_scaled_copy(0, 0, 1600, 1200));
  EXPECT_FALSE(is_scaled_copy(800, 600, 1600, 0));
}

/// The same ray meets the same part of both images' areas.
TEST(ScaledTo, KeepsTheImagePlane) {
  const Intrinsics k{1600, 1200, 1500, 1490, 3, 801.25, 590.5};
  for (const auto& [width, height] : {std::pair(800, 600), std::pair(3200, 2400)}) {
    const Intrinsics s = scaled_to(k, width, height);
    EXPECT_EQ(s.width, width);
    EXPECT_EQ(s.height, height);
    for (const glm::dvec3& p : {glm::dvec3(0, 0, 1), glm::dvec3(0.3, -0.2, 1)}) {
      const glm::dvec3 a = k.k() * p, b = s.k() * p;
      EXPECT_NEAR((b.x + 0.5) / width, (a.x + 0.5) / k.width, 1e-14);
      EXPECT_NEAR((b.y + 0.5) / height, (a.y + 0.5) / k.height, 1e-14);
      EXPECT_NEAR(glm::distance(scaled_to(glm::dvec2(a), k, width, height), glm::dvec2(b)), 0,
                  1e-11);
    }
  }
  EXPECT_DOUBLE_EQ(scaled_to(k, 800, 600).cx, 400.375);  // 801.75 / 2 - 0.5
  // The corner of the image stays its corner.
  EXPECT_EQ(scaled_to(glm::dvec2(-0.5, -0.5), k, 800, 600), glm::dvec2(-0.5, -0.5));
}

}  // namespace
}  // namespace photohull
