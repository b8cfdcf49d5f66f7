#include <gtest/gtest.h>

#include "temple.h"

namespace photohull::pipeline {
namespace {

TEST(TempleSlow, TheHullConvergesAsVoxelsShrink) {
  const double coarse = solid(reconstruct_temple(64, Method::kHull));
  const double fine = solid(reconstruct_temple(256, Method::kHull));
  const double finer = solid(reconstruct_temple(384, Method::kHull));
  EXPECT_NEAR(fine, finer, 0.003 * finer);
  EXPECT_NEAR(coarse, finer, 0.02 * finer);
}

TEST(TempleSlow, WorkAndMemoryGrowWithTheSurfaceNotTheVolume) {
  const Report half = reconstruct_temple(256, Method::kHull).report;
  const Report full = reconstruct_temple(512, Method::kHull).report;
  // Twice the resolution: four times the surface, eight times the volume.
  EXPECT_LT(double(full.bricks_stored), 4.5 * double(half.bricks_stored));
  EXPECT_LT(double(full.hull.bricks_evaluated), 4.5 * double(half.hull.bricks_evaluated));
  EXPECT_LT(double(full.hull.nodes_tested), 4.5 * double(half.hull.nodes_tested));
}

TEST(TempleSlow, SpaceCarvingAtNormalSizeStaysInsideTheHull) {
  const Reconstruction hull = reconstruct_temple(192, Method::kHull);
  const Reconstruction carved = reconstruct_temple(192, Method::kSpaceCarving);
  EXPECT_LT(solid(carved), solid(hull));
  EXPECT_GT(solid(carved), 0.9 * solid(hull));
}

}  // namespace
}  // namespace photohull::pipeline
