#include "volume/cavities.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

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

/// What faces join to the grid's border, voxel by voxel.
std::vector<bool> joined_to_border(const SparseVolume& volume) {
  const ivec3 n = volume.grid.voxels();
  const auto index = [&](const ivec3& v) { return std::size_t((v.z * n.y + v.y) * n.x + v.x); };
  std::vector<bool> joined(std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z), false);
  std::vector<ivec3> next;
  const auto enter = [&](const ivec3& v) {
    if (glm::any(glm::lessThan(v, ivec3(0))) || glm::any(glm::greaterThanEqual(v, n))) return;
    if (volume.at(v) < 0 || joined[index(v)]) return;
    joined[index(v)] = true;
    next.push_back(v);
  };
  for (int i = 0; i < n.x * n.y * n.z; ++i) {
    const ivec3 v(i % n.x, i / n.x % n.y, i / n.x / n.y);
    if (glm::any(glm::equal(v, ivec3(0))) || glm::any(glm::equal(v, n - 1))) enter(v);
  }
  while (!next.empty()) {
    const ivec3 v = next.back();
    next.pop_back();
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        ivec3 beside = v;
        beside[axis] += side;
        enter(beside);
      }
  }
  return joined;
}

TEST(FillCavities, RandomSpongesAreFilledWhereNoFacesLeadOut) {
  std::mt19937 random(5);
  std::size_t filled = 0;
  for (int round = 0; round < 8; ++round) {
    // About as dense as where ways out begin to be rare.
    SparseVolume volume = sample_volume({3, 2, 4}, [&](const dvec3&) {
      return random() % 100 < 28 + unsigned(round) ? 0.7 : -0.7;
    });
    const SparseVolume before = volume;
    const std::vector<bool> joined = joined_to_border(before);
    std::size_t expected = 0;
    const ivec3 n = volume.grid.voxels();
    const std::size_t count = fill_cavities(volume);
    for (int i = 0; i < n.x * n.y * n.z; ++i) {
      const ivec3 v(i % n.x, i / n.x % n.y, i / n.x / n.y);
      const bool closed = !(before.at(v) < 0) && !joined[std::size_t(i)];
      expected += closed;
      EXPECT_EQ(volume.at(v), closed ? -SparseVolume::kBand : before.at(v));
    }
    EXPECT_EQ(count, expected);
    filled += count;
  }
  EXPECT_GT(filled, 100u);
}

TEST(FillCavities, EmptyVolume) {
  SparseVolume volume = sample_volume({2, 2, 2}, [](const dvec3&) { return 9.0; });
  EXPECT_EQ(fill_cavities(volume), 0u);
}

}  // namespace
}  // namespace photohull
