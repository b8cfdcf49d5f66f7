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

TEST(Resembles, TheSharesThatLieInTheHull) {
  const SparseVolume hull = ball(kBallMiddle);
  EXPECT_TRUE(resembles(ball(kBallMiddle), hull, {}));
  // Balls whose middles are d radii apart share 1 - 3/4 d + d^3 / 16 of their volume.
  EXPECT_TRUE(resembles(ball(kBallMiddle + glm::dvec3(0.5 * kBallRadius, 0, 0)), hull, {}))
      << "0.633";
  EXPECT_FALSE(resembles(ball(kBallMiddle + glm::dvec3(0, 0.6 * kBallRadius, 0)), hull, {}))
      << "0.564";
}

TEST(Resembles, OnAnyLattice) {
  const SparseVolume hull =
      sample_volume(glm::ivec3(7), sphere(kBallMiddle, kBallRadius), glm::dvec3(100), 0.5);
  const glm::dvec3 world = glm::dvec3(100) + 0.5 * kBallMiddle;
  const auto at = [&](const glm::dvec3& middle) {
    return sample_volume(glm::ivec3(4), sphere((middle - glm::dvec3(101)) / 1.0, 0.5 * kBallRadius),
                         glm::dvec3(101), 1.0);
  };
  EXPECT_TRUE(resembles(at(world), hull, {}));
  EXPECT_FALSE(resembles(at(world + glm::dvec3(0, 0, kBallRadius)), hull, {}));
}

TEST(Resembles, NothingResemblesNothing) {
  const SparseVolume hull = ball(kBallMiddle);
  const SparseVolume empty = sample_volume(glm::ivec3(7), [](const glm::dvec3&) { return 9.0; });
  EXPECT_FALSE(resembles(empty, hull, {}));
  EXPECT_FALSE(resembles(hull, empty, {}));
}

}  // namespace
}  // namespace photohull::refine
