#include "core/grid.h"

#include <gtest/gtest.h>

#include <set>

namespace photohull {
namespace {

GridSpec small_grid() { return {{1, -2, 3}, 0.25, {2, 3, 4}}; }

TEST(GridSpec, VoxelCentresAndBounds) {
  const GridSpec grid = small_grid();
  EXPECT_EQ(grid.voxels(), glm::ivec3(16, 24, 32));
  EXPECT_EQ(grid.world({0, 0, 0}), grid.origin);
  EXPECT_EQ(grid.world({4, 8, 12}), glm::dvec3(2, 0, 6));
  const Box bounds = grid.bounds();
  EXPECT_EQ(bounds.min, grid.world(glm::dvec3(-0.5)));
  EXPECT_EQ(bounds.max, grid.world(glm::dvec3(grid.voxels()) - 0.5));
}

TEST(GridSpec, BrickIndicesAreABijectionWithXFastest) {
  const GridSpec grid = small_grid();
  EXPECT_EQ(grid.brick_index({1, 0, 0}), 1u);
  EXPECT_EQ(grid.brick_index({0, 1, 0}), 2u);
  EXPECT_EQ(grid.brick_index({0, 0, 1}), 6u);
  std::set<std::size_t> seen;
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 2; ++x) seen.insert(grid.brick_index({x, y, z}));
  EXPECT_EQ(seen.size(), grid.brick_count());
  EXPECT_EQ(*seen.rbegin(), grid.brick_count() - 1);
}

TEST(GridSpec, BrickIndexDoesNotOverflowIntegers) {
  const GridSpec grid{{0, 0, 0}, 1, {4096, 4096, 4096}};
  EXPECT_EQ(grid.brick_count(), std::size_t(1) << 36);
  EXPECT_EQ(grid.brick_index({4095, 4095, 4095}), grid.brick_count() - 1);
}

TEST(VoxelOffset, ZIsFastestAsInAnOpenVdbLeaf) {
  EXPECT_EQ(voxel_offset({0, 0, 1}), 1);
  EXPECT_EQ(voxel_offset({0, 1, 0}), 8);
  EXPECT_EQ(voxel_offset({1, 0, 0}), 64);
  EXPECT_EQ(voxel_offset({7, 7, 7}), kBrickVoxels - 1);
}

/// Brick 0 is stored, brick 1 inside, the others outside.
SparseVolume small_volume() {
  SparseVolume volume;
  volume.grid = small_grid();
  volume.table.assign(volume.grid.brick_count(), SparseVolume::kOutside);
  volume.table[0] = 0;
  volume.table[1] = SparseVolume::kInside;
  volume.bricks = {{0, 0, 0}};
  volume.distance.assign(kBrickVoxels, 0.5f);
  volume.distance[voxel_offset({1, 2, 3})] = -0.75f;
  return volume;
}

TEST(SparseVolume, ReadsStoredInsideAndOutside) {
  const SparseVolume volume = small_volume();
  EXPECT_EQ(volume.at({1, 2, 3}), -0.75f);
  EXPECT_EQ(volume.at({0, 0, 0}), 0.5f);
  EXPECT_EQ(volume.at({8, 0, 0}), -SparseVolume::kBand);
  EXPECT_EQ(volume.at({0, 8, 0}), SparseVolume::kBand);
}

TEST(SparseVolume, IsOutsideBeyondTheGrid) {
  const SparseVolume volume = small_volume();
  for (int axis = 0; axis < 3; ++axis) {
    glm::ivec3 voxel(0);
    voxel[axis] = -1;
    EXPECT_EQ(volume.at(voxel), SparseVolume::kBand);
    voxel[axis] = volume.grid.voxels()[axis];
    EXPECT_EQ(volume.at(voxel), SparseVolume::kBand);
  }
}

TEST(SparseVolume, CountsInsideVoxels) {
  EXPECT_EQ(small_volume().inside_voxels(), std::size_t(kBrickVoxels + 1));
}

TEST(SparseVolume, InterpolationIsExactForWhatIsLinearInEachCoordinate) {
  SparseVolume volume = small_volume();
  const auto f = [](double x, double y, double z) { return 0.1 * x - 0.05 * y * z + 0.2 * z; };
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y)
      for (int z = 0; z < 8; ++z) volume.distance[voxel_offset({x, y, z})] = float(f(x, y, z));
  for (const glm::dvec3& p : {glm::dvec3(1.25, 2.5, 3.75), glm::dvec3(0), glm::dvec3(6.9, 0.1, 2)})
    EXPECT_NEAR(volume.interpolated(p), f(p.x, p.y, p.z), 1e-6);
  // Half way to what is not stored: inside along x, outside the grid below.
  EXPECT_NEAR(volume.interpolated({7.5, 1, 1}), 0.5 * (f(7, 1, 1) - SparseVolume::kBand), 1e-6);
  EXPECT_NEAR(volume.interpolated({-0.5, 1, 1}), 0.5 * (f(0, 1, 1) + SparseVolume::kBand), 1e-6);
  EXPECT_NEAR(volume.interpolated({-40, 1, 1}), SparseVolume::kBand, 1e-6);
}

}  // namespace
}  // namespace photohull
