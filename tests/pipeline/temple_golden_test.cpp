// What photohull makes of the temple, held against recorded results. The bounds are a few times
// what devices differ by, and far below what a wrong camera convention, mask or sweep changes.
#include <gtest/gtest.h>

#include "temple.h"

namespace photohull::pipeline {
namespace {

TEST(TempleGolden, HullKeepsItsVolume) {
  const Reconstruction hull = reconstruct_temple(96, Method::kHull);
  // Masks are made here, so that no view carves alone (decision 0030).
  EXPECT_NEAR(double(hull.report.voxels_kept), 69079, 0.005 * 69079);
  EXPECT_NEAR(double(hull.report.mesh.triangles), 45812, 0.02 * 45812);
  EXPECT_EQ(hull.report.photographs.mask_source, "background model");
  EXPECT_NEAR(hull.report.photographs.mask_confidence, 0.52, 0.05);  // the least of the views'
}

TEST(TempleGolden, SpaceCarvingTakesAFewPercentOfTheHullAndAddsNothing) {
  const Reconstruction hull = reconstruct_temple(96, Method::kHull);
  const Reconstruction carved = reconstruct_temple(96, Method::kSpaceCarving);
  EXPECT_NEAR(double(carved.report.voxels_kept), 63166, 0.01 * 63166);
  // Specks that carving cuts off are dropped without being counted as carved.
  const auto accounted =
      double(carved.report.voxels_kept + carved.report.surface.sweep.voxels_carved);
  EXPECT_LE(accounted, double(hull.report.voxels_kept));
  EXPECT_GE(accounted, 0.999 * double(hull.report.voxels_kept));
  ASSERT_EQ(carved.volume.grid.voxel_size, hull.volume.grid.voxel_size);
  // The files' grids can begin at different bricks.
  const glm::ivec3 shift(glm::round((carved.volume.grid.origin - hull.volume.grid.origin) /
                                    hull.volume.grid.voxel_size));
  const glm::ivec3 size = carved.volume.grid.voxels();
  int added = 0;
  for (int x = 0; x < size.x; ++x)
    for (int y = 0; y < size.y; ++y)
      for (int z = 0; z < size.z; ++z)
        added +=
            carved.volume.at({x, y, z}) < 0 && !(hull.volume.at(glm::ivec3(x, y, z) + shift) < 0);
  EXPECT_EQ(added, 0);
}

TEST(TempleGolden, VoxelColoringIsOneSweep) {
  const Reconstruction result = reconstruct_temple(64, Method::kVoxelColoring);
  EXPECT_EQ(result.report.surface.sweep.sweeps, 1);
  EXPECT_GT(result.report.surface.sweep.voxels_judged, 1000);
}

}  // namespace
}  // namespace photohull::pipeline
