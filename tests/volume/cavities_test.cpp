#include "volume/cavities.h"

#include <gtest/gtest.h>

#include "support/analytic_volumes.h"

namespace photohull {
namespace {

using glm::dvec3;
using glm::ivec3;

/// A ball with a hollow of radius 4 about (16, 16, 16), across eight bricks.
double hollow_ball(const dvec3& p) {
  return std::max(sphere(dvec3(16), 12)(p), -sphere(dvec3(16), 4)(p));
}

std::size_t voxels_within(double radius) {
  std::size_t count = 0;
  for (int i = 0; i < 32 * 32 * 32; ++i)
    count += glm::distance(dvec3(i % 32, i / 32 % 32, i / 1024), dvec3(16)) <= radius;
  return count;
}

TEST(FillCavities, AHollowBecomesBody) {
  SparseVolume volume = sample_volume({4, 4, 4}, hollow_ball);
  const std::size_t before = volume.inside_voxels();
  EXPECT_EQ(fill_cavities(volume), voxels_within(4));
  EXPECT_GE(volume.inside_voxels(), before + voxels_within(4));
  EXPECT_LT(volume.at({16, 16, 16}), 0);
  EXPECT_GT(volume.at({1, 1, 1}), 0);
  EXPECT_EQ(fill_cavities(volume), 0u);
}

TEST(FillCavities, AHollowWithAWayOutStays) {
  for (const ivec3& way : {ivec3(1, 0, 0), ivec3(0, -1, 0), ivec3(0, 0, 1)}) {
    SparseVolume volume = sample_volume({4, 4, 4}, [&](const dvec3& p) {
      const dvec3 d = p - 16.0;
      const double along = glm::dot(d, dvec3(way));
      const double tunnel = along < 0 ? 9 : glm::length(d - along * dvec3(way)) - 0.5;
      return std::max(hollow_ball(p), -tunnel);
    });
    const SparseVolume before = volume;
    EXPECT_EQ(fill_cavities(volume), 0u);
    EXPECT_EQ(volume.distance, before.distance);
  }
}

TEST(FillCavities, ACornerIsNoWayOut) {
  SparseVolume volume = sample_volume({4, 4, 4}, hollow_ball);
  // A diagonal of single voxels from the hollow to beyond the ball.
  const auto carve = [&](const ivec3& voxel) {
    const std::uint32_t slot = volume.table[volume.grid.brick_index(voxel / kBrickEdge)];
    if (slot < SparseVolume::kInside)
      volume.distance[slot * std::size_t(kBrickVoxels) + std::size_t(voxel_offset(voxel & 7))] = 1;
  };
  for (int i = 16; i < 30; ++i) carve(ivec3(i));
  EXPECT_GE(fill_cavities(volume), voxels_within(4));
  EXPECT_LT(volume.at({16, 16, 16}), 0);
}

TEST(FillCavities, TheGridsBorderIsOutside) {
  // The whole grid is body but for a pit at its border.
  SparseVolume pit = sample_volume({2, 2, 2}, [](const dvec3& p) {
    return -sphere({0, 8, 8}, 4)(p);
  });
  EXPECT_EQ(fill_cavities(pit), 0u);
  SparseVolume bubble = sample_volume({2, 2, 2}, [](const dvec3& p) {
    return -sphere({8, 8, 8}, 4)(p);
  });
  EXPECT_GT(fill_cavities(bubble), 200u);
  EXPECT_EQ(bubble.inside_voxels(), 16u * 16 * 16);
}

TEST(FillCavities, ALargeHollowWithEmptyBricksInIt) {
  SparseVolume volume = sample_volume({8, 8, 8}, [](const dvec3& p) {
    return std::max(sphere(dvec3(31.5), 28)(p), -sphere(dvec3(31.5), 20)(p));
  });
  ASSERT_EQ(volume.table[volume.grid.brick_index({3, 3, 3})], SparseVolume::kOutside);
  EXPECT_GT(fill_cavities(volume), 20000u);
  EXPECT_LT(volume.at({31, 31, 31}), 0);
  EXPECT_GT(volume.at({1, 1, 1}), 0);
}

TEST(FillCavities, EmptyVolume) {
  SparseVolume volume = sample_volume({2, 2, 2}, [](const dvec3&) { return 9.0; });
  EXPECT_EQ(fill_cavities(volume), 0u);
}

}  // namespace
}  // namespace photohull
