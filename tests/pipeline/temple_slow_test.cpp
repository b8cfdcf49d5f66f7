#include <gtest/gtest.h>

#include "temple.h"

namespace photohull::pipeline {
namespace {

TEST(TempleSlow, TheHullConvergesAsVoxelsShrink) {
  const double coarse = reconstruct_temple(64, Method::kHull).solid();
  const double fine = reconstruct_temple(256, Method::kHull).solid();
  const double finer = reconstruct_temple(384, Method::kHull).solid();
  EXPECT_NEAR(fine, finer, 0.003 * finer);
  EXPECT_NEAR(coarse, finer, 0.02 * finer);
}

TEST(TempleSlow, WorkAndMemoryGrowWithTheSurfaceNotTheVolume) {
  const Report half = reconstruct_temple(256, Method::kHull).report;
  const Report full = reconstruct_temple(512, Method::kHull).report;
  // Twice the resolution: four times the surface, eight times the volume.
  EXPECT_LT(double(full.bricks_stored), 4.5 * double(half.bricks_stored));
  EXPECT_LT(double(full.bricks_evaluated), 4.5 * double(half.bricks_evaluated));
  EXPECT_LT(double(full.nodes_tested), 4.5 * double(half.nodes_tested));
}

TEST(TempleSlow, SpaceCarvingAtNormalSizeStaysInsideTheHull) {
  const Reconstruction hull = reconstruct_temple(192, Method::kHull);
  const Reconstruction carved = reconstruct_temple(192, Method::kSpaceCarving);
  EXPECT_LT(carved.solid(), hull.solid());
  EXPECT_GT(carved.solid(), 0.9 * hull.solid());
}

}  // namespace
}  // namespace photohull::pipeline
