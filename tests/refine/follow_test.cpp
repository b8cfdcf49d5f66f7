#include "refine/follow.h"

#include <gtest/gtest.h>

#include "support/analytic_volumes.h"

namespace photohull::refine {
namespace {

constexpr double kBallRadius = 18;
const glm::dvec3 kBallMiddle(28.0);

SparseVolume ball(const glm::dvec3& middle) {
  return sample_volume(glm::ivec3(7), sphere(middle, kBallRadius));
}

int levels_of(const SparseVolume& before, const SparseVolume& hull, bool followed = false) {
  return levels_from({before, followed}, hull, {});
}

TEST(LevelsFrom, TheShareThatLiesInTheHull) {
  const SparseVolume hull = ball(kBallMiddle);
  EXPECT_EQ(levels_of(ball(kBallMiddle), hull), 2);
  // Balls whose middles are d radii apart share 1 - 3/4 d + d^3 / 16 of their volume.
  EXPECT_EQ(levels_of(ball(kBallMiddle + glm::dvec3(0.5 * kBallRadius, 0, 0)), hull), 2) << "0.633";
  EXPECT_EQ(levels_of(ball(kBallMiddle + glm::dvec3(0, 0.6 * kBallRadius, 0)), hull), 0) << "0.564";
}

TEST(LevelsFrom, TheLastOneAloneWhereWhatFollowedHasHardlyMoved) {
  const SparseVolume hull = ball(kBallMiddle);
  EXPECT_EQ(levels_of(ball(kBallMiddle), hull, true), 1);
  // Moved by d voxels, what is farther out than one is 3/8 (d - 1)^2 / radius^2 of the ball or
  // less.
  EXPECT_EQ(levels_of(ball(kBallMiddle + glm::dvec3(1, 0, 0)), hull, true), 1);
  EXPECT_EQ(levels_of(ball(kBallMiddle + glm::dvec3(0, 0, 4)), hull, true), 2);
  EXPECT_EQ(levels_of(ball(kBallMiddle + glm::dvec3(0, 14, 0)), hull, true), 0);
}

TEST(LevelsFrom, OnAnyLattice) {
  const SparseVolume hull =
      sample_volume(glm::ivec3(7), sphere(kBallMiddle, kBallRadius), glm::dvec3(100), 0.5);
  const glm::dvec3 world = glm::dvec3(100) + 0.5 * kBallMiddle;
  const auto at = [&](const glm::dvec3& middle) {
    return sample_volume(glm::ivec3(4), sphere((middle - glm::dvec3(101)) / 1.0, 0.5 * kBallRadius),
                         glm::dvec3(101), 1.0);
  };
  EXPECT_EQ(levels_of(at(world), hull), 2);
  EXPECT_EQ(levels_of(at(world + glm::dvec3(0, 0, kBallRadius)), hull), 0);
}

TEST(LevelsFrom, NothingServesNothing) {
  const SparseVolume hull = ball(kBallMiddle);
  const SparseVolume empty = sample_volume(glm::ivec3(7), [](const glm::dvec3&) { return 9.0; });
  EXPECT_EQ(levels_of(empty, hull), 0);
  EXPECT_EQ(levels_of(hull, empty), 0);
}

}  // namespace
}  // namespace photohull::refine
