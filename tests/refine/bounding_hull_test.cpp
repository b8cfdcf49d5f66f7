#include "refine/bounding_hull.h"

#include <gtest/gtest.h>

#include "support/analytic_volumes.h"
#include "volume/combine.h"

namespace photohull::refine {
namespace {

class BoundingHullTest : public testing::Test {
 protected:
  static SparseVolume ball(const glm::dvec3& centre, double radius) {
    return sample_volume({8, 8, 8}, sphere(centre, radius));
  }

  SparseVolume hull_ = sample_volume({8, 8, 8}, box(glm::dvec3(4), glm::dvec3(59)));
  SparseVolume volume_ = ball({6, 31, 31}, 8);  // the box cuts it off
  BoundingHull bounding_{hull_};
};

TEST_F(BoundingHullTest, IntersectsAsTheWholeHull) {
  bounding_.drop_far_from(volume_);
  EXPECT_LT(bounding_.volume().bricks.size(), hull_.bricks.size() / 2);
  ASSERT_TRUE(bounding_.bounds(volume_));
  const SparseVolume whole = intersection(volume_, hull_),
                     near = intersection(volume_, bounding_.volume());
  EXPECT_EQ(near.table, whole.table);
  EXPECT_EQ(near.bricks, whole.bricks);
  EXPECT_EQ(near.distance, whole.distance);
}

TEST_F(BoundingHullTest, TellsWhatItLacks) {
  EXPECT_TRUE(bounding_.bounds(ball({58, 31, 31}, 8)));  // nothing was dropped yet
  bounding_.drop_far_from(volume_);
  EXPECT_FALSE(bounding_.bounds(ball({58, 31, 31}, 8)));
  EXPECT_TRUE(bounding_.bounds(ball({6, 33, 29}, 8)));   // moved by a little
  EXPECT_TRUE(bounding_.bounds(ball({31, 31, 31}, 8)));  // where the hull is whole
}

}  // namespace
}  // namespace photohull::refine
