#include "refine/voxel_set.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace photohull::refine {
namespace {

/// Each voxel's neighbours one by one.
VoxelSet around_by_hand(std::span<const glm::vec3> points, const GridSpec& grid) {
  const Lattice lattice(grid);
  std::set<std::uint64_t> set;
  for (const glm::vec3& p : points)
    for (int i = 0; i < 27; ++i) {
      const glm::ivec3 voxel =
          glm::ivec3(glm::floor(p + 0.5f)) + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
      if (lattice.contains(voxel)) set.insert(lattice.index(voxel));
    }
  return {set.begin(), set.end()};
}

TEST(VoxelSet, AroundPoints) {
  const GridSpec grid{glm::dvec3(0), 1, {9, 2, 3}};  // rows of more than a word
  std::mt19937 random(5);
  for (const int count : {0, 1, 50, 3000}) {
    std::vector<glm::vec3> points;
    for (int i = 0; i < count; ++i) {
      const auto share = [&] { return float(random() % 1000) / 1000; };
      // Beside the lattice, too.
      points.emplace_back(glm::vec3(share(), share(), share()) * glm::vec3(82, 26, 34) - 5.0f);
    }
    EXPECT_EQ(around(points, grid), around_by_hand(points, grid));
  }
}

TEST(VoxelSet, CornersOfTheLattice) {
  const GridSpec grid{glm::dvec3(0), 1, {8, 1, 1}};
  const std::vector<glm::vec3> points = {{-1, -1, -1}, {64, 8, 8}, {-2, 0, 0}, {0, 0, 9}};
  EXPECT_EQ(around(points, grid), (VoxelSet{0, 8 * 8 * 64 - 1}));
}

}  // namespace
}  // namespace photohull::refine
