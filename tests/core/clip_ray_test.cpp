#include "core/clip_ray.h"

#include <gtest/gtest.h>

namespace photohull {
namespace {

const Box kBox{{-1, -2, -3}, {1, 2, 3}};

TEST(ClipRay, GivesThePartInTheBox) {
  const auto through = clip_ray(kBox, {-5, 0, 0}, {2, 0, 0});
  ASSERT_TRUE(through);
  EXPECT_DOUBLE_EQ(through->first, 2);
  EXPECT_DOUBLE_EQ(through->second, 3);
  const auto from_inside = clip_ray(kBox, {0, 0, 0}, {0, 0, -1});
  ASSERT_TRUE(from_inside);
  EXPECT_DOUBLE_EQ(from_inside->first, 0);
  EXPECT_DOUBLE_EQ(from_inside->second, 3);
}

TEST(ClipRay, MissesWhatIsBesideAndBehind) {
  EXPECT_FALSE(clip_ray(kBox, {-5, 2.1, 0}, {1, 0, 0}));
  EXPECT_FALSE(clip_ray(kBox, {-5, 0, 0}, {-1, 0, 0}));
  EXPECT_FALSE(clip_ray(kBox, {-3, 0, 0}, {1, 1.01, 0}));
  EXPECT_FALSE(clip_ray(kBox, {0, 3, 0}, {1, 0, 0}));  // parallel to the sides that it misses
}

TEST(ClipRay, AlongAFaceIsInside) {
  const auto part = clip_ray(kBox, {-5, 2, 0}, {1, 0, 0});
  ASSERT_TRUE(part);
  EXPECT_DOUBLE_EQ(part->first, 4);
  EXPECT_DOUBLE_EQ(part->second, 6);
}

}  // namespace
}  // namespace photohull
