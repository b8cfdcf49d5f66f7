#include "volume/combine.h"

#include <gtest/gtest.h>

#include "support/analytic_volumes.h"

namespace photohull {
namespace {

using glm::dvec3;
using glm::ivec3;

/// Every voxel of `found` against choose(a, b), the sides of bricks that are not stored included.
template <typename F>
void expect_combined(const SparseVolume& found, const SparseVolume& a, const SparseVolume& b,
                     F&& choose) {
  ASSERT_EQ(found.table.size(), found.grid.brick_count());
  ASSERT_EQ(found.distance.size(), found.bricks.size() * kBrickVoxels);
  for (std::size_t slot = 0; slot < found.bricks.size(); ++slot)
    ASSERT_EQ(found.table[found.grid.brick_index(found.bricks[slot])], slot);
  const ivec3 n = found.grid.voxels();
  int wrong = 0;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x)
        wrong += found.at({x, y, z}) != choose(a.at({x, y, z}), b.at({x, y, z}));
  EXPECT_EQ(wrong, 0);
}

void expect_both(const SparseVolume& a, const SparseVolume& b) {
  const auto greater = [](float x, float y) { return std::max(x, y); };
  const auto lesser = [](float x, float y) { return std::min(x, y); };
  expect_combined(intersection(a, b), a, b, greater);
  expect_combined(intersection(b, a), a, b, greater);
  expect_combined(union_of(a, b), a, b, lesser);
  expect_combined(union_of(b, a), a, b, lesser);
}

TEST(Combine, OverlappingBalls) {
  const SparseVolume a = sample_volume({6, 5, 5}, sphere(dvec3(19), 16), {1, 2, 3}, 0.5);
  const SparseVolume b = sample_volume({6, 5, 5}, sphere({27, 21, 20}, 15), {1, 2, 3}, 0.5);
  expect_both(a, b);
  expect_both(a, a);
  EXPECT_EQ(intersection(a, b).grid.voxel_size, 0.5);
}

TEST(Combine, DistantAndNestedBalls) {
  const SparseVolume a = sample_volume({6, 5, 5}, sphere(dvec3(12), 8));
  const SparseVolume b = sample_volume({6, 5, 5}, sphere({38, 30, 30}, 6));
  const SparseVolume around = sample_volume({6, 5, 5}, sphere(dvec3(19), 19));
  expect_both(a, b);
  EXPECT_EQ(intersection(a, b).inside_voxels(), 0u);
  EXPECT_EQ(union_of(a, b).inside_voxels(), a.inside_voxels() + b.inside_voxels());
  expect_both(a, around);
}

TEST(Combine, NothingAndEverything) {
  const SparseVolume ball = sample_volume({3, 3, 3}, sphere(dvec3(12), 8));
  const SparseVolume nothing = sample_volume({3, 3, 3}, [](const dvec3&) { return 9.0; });
  const SparseVolume all = sample_volume({3, 3, 3}, [](const dvec3&) { return -9.0; });
  for (const SparseVolume& other : {nothing, all}) expect_both(ball, other);
  EXPECT_TRUE(intersection(ball, nothing).bricks.empty());
  EXPECT_TRUE(union_of(ball, all).bricks.empty());
  EXPECT_EQ(union_of(nothing, all).inside_voxels(), 24u * 24 * 24);
}

}  // namespace
}  // namespace photohull
