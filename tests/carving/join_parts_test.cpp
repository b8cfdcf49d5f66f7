// Gaps of a volume closed by the fewest voxels.
#include "carving/join_parts.h"

#include <gtest/gtest.h>

#include <set>

namespace photohull::carving {
namespace {

using glm::ivec3;

/// A volume that holds just these voxels.
SparseVolume volume_of(const std::vector<ivec3>& voxels) {
  SparseVolume volume;
  volume.grid.voxel_size = 1;
  volume.grid.bricks = ivec3(3);
  volume.table.assign(volume.grid.brick_count(), SparseVolume::kOutside);
  for (std::uint32_t i = 0; i < volume.grid.brick_count(); ++i) {
    volume.table[i] = i;
    volume.bricks.emplace_back(i % 3, i / 3 % 3, i / 9);
  }
  volume.distance.assign(volume.grid.brick_count() * kBrickVoxels, SparseVolume::kBand);
  for (const ivec3& v : voxels)
    volume.distance[volume.grid.brick_index(v / kBrickEdge) * kBrickVoxels +
                    std::size_t(voxel_offset(v % kBrickEdge))] = -0.5f;
  return volume;
}

std::vector<ivec3> row(int from, int to) {
  std::vector<ivec3> voxels;
  for (int x = from; x < to; ++x) voxels.emplace_back(x, 10, 10);
  return voxels;
}

std::vector<ivec3> two_rods() {
  std::vector<ivec3> voxels = row(2, 8);
  for (const ivec3& v : row(11, 20)) voxels.push_back(v);
  return voxels;
}

TEST(FindJoining, AGapIsClosedByItsOwnVoxels) {
  std::vector<Joint> joints;
  for (int x = 1; x < 22; ++x)
    for (const ivec3& beside : {ivec3(x, 9, 10), ivec3(x, 11, 10)})
      joints.push_back({beside, -0.1f});
  for (int x = 8; x < 11; ++x) joints.push_back({{x, 10, 10}, -0.4f});
  std::set<int> filled;
  for (const std::size_t i : find_joining(volume_of(two_rods()), joints)) {
    EXPECT_EQ(joints[i].voxel.y, 10) << joints[i].voxel.x;
    filled.insert(joints[i].voxel.x);
  }
  EXPECT_EQ(filled, (std::set<int>{8, 9, 10}));
}

TEST(FindJoining, TheDeepestWayIsTaken) {
  std::vector<Joint> joints;
  for (int x = 7; x < 12; ++x) joints.push_back({{x, 11, 10}, -0.4f});
  for (int x = 8; x < 11; ++x) joints.push_back({{x, 10, 10}, -0.1f});
  const auto found = find_joining(volume_of(two_rods()), joints);
  ASSERT_FALSE(found.empty());
  for (const std::size_t i : found) EXPECT_EQ(joints[i].voxel.y, 11);
}

TEST(FindJoining, WhatHangsTogetherGetsNothing) {
  std::vector<Joint> joints;
  for (int x = 3; x < 18; ++x) joints.push_back({{x, 11, 10}, -0.4f});
  EXPECT_TRUE(find_joining(volume_of(row(2, 20)), joints).empty());
}

TEST(FindJoining, AGapThatJointsDoNotSpanStays) {
  const std::vector<Joint> joints{{{8, 10, 10}, -0.3f}, {{10, 10, 10}, -0.3f}};
  EXPECT_TRUE(find_joining(volume_of(two_rods()), joints).empty());
}

TEST(FindJoining, SharedEdgesDoNotHoldTogether) {
  // The surface may part voxels that share no face.
  std::vector<ivec3> voxels = row(2, 8);
  for (int x = 8; x < 14; ++x) voxels.emplace_back(x, 11, 10);
  const std::vector<Joint> joints{{{8, 10, 10}, -0.3f}};
  EXPECT_EQ(find_joining(volume_of(voxels), joints).size(), 1u);
}

TEST(FindJoining, NothingIsNeededWhereThereIsNothing) {
  EXPECT_TRUE(find_joining(volume_of({}), {}).empty());
  const std::vector<Joint> joints{{{0, 0, 0}, -0.3f}, {{23, 23, 23}, -0.3f}};
  EXPECT_TRUE(find_joining(volume_of({}), joints).empty());
}

}  // namespace
}  // namespace photohull::carving
