#include "carving/bit_volume.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/cameras.h"

namespace photohull::carving {
namespace {

using glm::ivec3;

/// Distance to a ball, clamped to the band, stored where the surface is near.
SparseVolume ball(const ivec3& bricks, const glm::dvec3& centre, double radius) {
  SparseVolume volume;
  volume.grid = {{0, 0, 0}, 1, bricks};
  for (int z = 0; z < bricks.z; ++z)
    for (int y = 0; y < bricks.y; ++y)
      for (int x = 0; x < bricks.x; ++x) {
        std::vector<float> values(kBrickVoxels);
        float low = 3, high = -3;
        for (int i = 0; i < kBrickVoxels; ++i) {
          const ivec3 voxel = ivec3(x, y, z) * 8 + ivec3(i >> 6, (i >> 3) & 7, i & 7);
          const double d = glm::distance(glm::dvec3(voxel), centre) - radius;
          values[i] = std::clamp(float(d), -3.0f, 3.0f);
          low = std::min(low, values[i]);
          high = std::max(high, values[i]);
        }
        if (low > 1 || high < -1) {
          volume.table.push_back(low > 0 ? SparseVolume::kOutside : SparseVolume::kInside);
          continue;
        }
        volume.table.push_back(std::uint32_t(volume.bricks.size()));
        volume.bricks.push_back({x, y, z});
        volume.distance.insert(volume.distance.end(), values.begin(), values.end());
      }
  return volume;
}

SparseVolume test_ball() { return ball({5, 5, 5}, {19.3, 20.1, 18.7}, 15.2); }

template <typename F>
void for_each_voxel(const GridSpec& grid, F&& f) {
  const ivec3 size = grid.voxels();
  for (int x = 0; x < size.x; ++x)
    for (int y = 0; y < size.y; ++y)
      for (int z = 0; z < size.z; ++z) f(ivec3(x, y, z));
}

TEST(BitVolume, StandsWhereTheDistanceIsNegative) {
  const SparseVolume volume = test_ball();
  const BitVolume bits = to_bits(volume);
  for_each_voxel(volume.grid, [&](const ivec3& voxel) {
    ASSERT_EQ(bits.standing(voxel), volume.at(voxel) < 0);
  });
  for (const ivec3& outside : {ivec3(-1, 4, 4), ivec3(4, -1, 4), ivec3(4, 4, 40)})
    EXPECT_FALSE(bits.standing(outside));
}

TEST(BitVolume, ClearsOneVoxelOnly) {
  const SparseVolume volume = test_ball();
  BitVolume bits = to_bits(volume);
  bits.clear({20, 21, 19});  // in a brick that is wholly inside
  bits.clear({20, 21, 5});
  int cleared = 0;
  for_each_voxel(volume.grid, [&](const ivec3& voxel) {
    cleared += (volume.at(voxel) < 0) != bits.standing(voxel);
  });
  EXPECT_EQ(cleared, 2);
  EXPECT_FALSE(bits.standing({20, 21, 19}));
  EXPECT_FALSE(bits.standing({20, 21, 5}));
}

TEST(CarvedDistance, EqualsTheHullWhereNothingWasCarved) {
  const SparseVolume hull = test_ball();
  const SparseVolume same = carved_distance(hull, to_bits(hull));
  EXPECT_EQ(same.table, hull.table);
  for_each_voxel(hull.grid, [&](const ivec3& voxel) { ASSERT_EQ(same.at(voxel), hull.at(voxel)); });
}

/// Carves a slot, a deep pit and single voxels out of the ball.
BitVolume carve(const SparseVolume& hull, test::Rng& rng) {
  BitVolume bits = to_bits(hull);
  for_each_voxel(hull.grid, [&](const ivec3& v) {
    const bool slot = v.x >= 14 && v.x < 25 && v.z < 9;
    const bool pit = std::abs(v.x - 20) < 2 && std::abs(v.z - 20) < 2 && v.y > 17;
    const bool dust = test::uniform(rng, 0, 1) < 0.001;
    if ((slot || pit || dust) && bits.standing(v)) bits.clear(v);
  });
  return bits;
}

TEST(CarvedDistance, SignsAgreeWithTheBits) {
  test::Rng rng(1);
  const SparseVolume hull = test_ball();
  const BitVolume bits = carve(hull, rng);
  const SparseVolume out = carved_distance(hull, bits);
  for_each_voxel(hull.grid, [&](const ivec3& voxel) {
    ASSERT_EQ(out.at(voxel) < 0, bits.standing(voxel))
        << voxel.x << ", " << voxel.y << ", " << voxel.z;
  });
}

TEST(CarvedDistance, BricksWithoutCarvingInReachEqualTheHull) {
  test::Rng rng(2);
  const SparseVolume hull = test_ball();
  const BitVolume bits = carve(hull, rng);
  const SparseVolume out = carved_distance(hull, bits);
  constexpr int kReach = 3;
  std::vector<std::uint8_t> near(hull.grid.brick_count());
  for_each_voxel(hull.grid, [&](const ivec3& voxel) {
    if (!(hull.at(voxel) < 0) || bits.standing(voxel)) return;
    for (int corner = 0; corner < 8; ++corner) {
      const ivec3 side(corner & 1, (corner >> 1) & 1, corner >> 2);
      const ivec3 reached =
          glm::clamp(voxel + (2 * side - 1) * kReach, ivec3(0), hull.grid.voxels() - 1);
      near[hull.grid.brick_index(reached / kBrickEdge)] = 1;
    }
  });
  int untouched = 0;
  for_each_voxel(hull.grid, [&](const ivec3& voxel) {
    if (near[hull.grid.brick_index(voxel / kBrickEdge)]) return;
    ++untouched;
    ASSERT_EQ(out.at(voxel), hull.at(voxel));
  });
  EXPECT_GT(untouched, 10 * kBrickVoxels);
}

TEST(CarvedDistance, NeverLessThanTheHullsAndWithinTheBand) {
  test::Rng rng(3);
  const SparseVolume hull = test_ball();
  const SparseVolume out = carved_distance(hull, carve(hull, rng));
  for_each_voxel(hull.grid, [&](const ivec3& voxel) {
    ASSERT_GE(out.at(voxel), hull.at(voxel));
    ASSERT_LE(out.at(voxel), SparseVolume::kBand);
  });
}

TEST(CarvedDistance, AFlatCutLiesBetweenItsVoxels) {
  // Everything with x >= 22 goes: the cut is the plane x = 21.5.
  const SparseVolume hull = test_ball();
  BitVolume bits = to_bits(hull);
  for_each_voxel(hull.grid, [&](const ivec3& v) {
    if (v.x >= 22 && bits.standing(v)) bits.clear(v);
  });
  const SparseVolume out = carved_distance(hull, bits);
  EXPECT_NEAR(out.at({21, 20, 19}), -0.5, 0.05);
  EXPECT_NEAR(out.at({22, 20, 19}), 0.5, 0.05);
  EXPECT_NEAR(out.at({20, 20, 19}), -1.5, 0.4);
  EXPECT_NEAR(out.at({23, 20, 19}), 1.5, 0.4);
}

TEST(CarvedDistance, AWhollyCarvedVolumeIsEmpty) {
  const SparseVolume hull = test_ball();
  BitVolume bits = to_bits(hull);
  for_each_voxel(hull.grid, [&](const ivec3& v) {
    if (bits.standing(v)) bits.clear(v);
  });
  EXPECT_EQ(carved_distance(hull, bits).inside_voxels(), 0u);
}

}  // namespace
}  // namespace photohull::carving
