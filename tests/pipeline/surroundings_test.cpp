#include "pipeline/surroundings.h"

#include <gtest/gtest.h>

namespace photohull::pipeline {
namespace {

const Box kBox{{-1, -1, -0.5}, {1, 1, 0.5}};

double longest(const Box& box) {
  const glm::dvec3 size = box.size();
  return std::max({size.x, size.y, size.z});
}

TEST(PlanShells, OneOfFourTimesTheBoxWhereNothingIsKnown) {
  const std::vector<Shell> shells = plan_shells(kBox, 0.01, std::nullopt);
  ASSERT_EQ(shells.size(), 1u);
  EXPECT_NEAR(longest(shells[0].box), 8, 1e-9);
  EXPECT_NEAR(shells[0].grid.voxel_size, 0.04, 1e-9);
}

TEST(PlanShells, ReachAsFarAsWhatIsSeenAndNoFarther) {
  const Box seen{{-2.5, -1, -1}, {4, 1, 1}};
  const std::vector<Shell> shells = plan_shells(kBox, 0.01, seen);
  ASSERT_EQ(shells.size(), 1u);
  EXPECT_TRUE(shells[0].box.contains(seen.min) && shells[0].box.contains(seen.max));
  EXPECT_LT(longest(shells[0].box), 7);
}

// A palace far behind a fountain takes coarser shells, each around the one before, and an end.
TEST(PlanShells, WhatIsFarTakesCoarserShells) {
  const std::vector<Shell> shells = plan_shells(kBox, 0.01, Box{{-1, -1, -1}, {20, 1, 1}});
  ASSERT_EQ(shells.size(), 2u);
  EXPECT_NEAR(shells[1].grid.voxel_size, 4 * shells[0].grid.voxel_size, 1e-9);
  EXPECT_TRUE(shells[1].box.contains(shells[0].box.min + 1e-9));
  EXPECT_TRUE(shells[1].box.contains(glm::dvec3(20, 1, 1)));
  EXPECT_LE(plan_shells(kBox, 0.01, Box{{-1e9, -1, -1}, {1e9, 1, 1}}).size(), 3u);
}

}  // namespace
}  // namespace photohull::pipeline
