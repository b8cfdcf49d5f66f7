#include "volume/components.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/error.h"
#include "support/analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

/// Flood fill over all voxels of the grid: slow, and plainly right.
std::vector<std::size_t> flooded_sizes(const SparseVolume& volume) {
  const glm::ivec3 size = volume.grid.voxels();
  std::vector<bool> seen(std::size_t(size.x) * size.y * size.z);
  const auto visit = [&](const glm::ivec3& v) {
    if (!(volume.at(v) < 0)) return false;
    auto flag = seen[(std::size_t(v.x) * size.y + v.y) * size.z + v.z];
    const bool first = !flag;
    flag = true;
    return first;
  };
  std::vector<std::size_t> sizes;
  for (int i = 0; i < size.x * size.y * size.z; ++i) {
    const glm::ivec3 seed(i / (size.y * size.z), i / size.z % size.y, i % size.z);
    if (!visit(seed)) continue;
    std::vector<glm::ivec3> front{seed};
    for (std::size_t next = 0; next < front.size(); ++next)
      for (int n = 0; n < 27; ++n) {
        const glm::ivec3 v = front[next] + glm::ivec3(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
        if (visit(v)) front.push_back(v);
      }
    sizes.push_back(front.size());
  }
  std::sort(sizes.begin(), sizes.end(), std::greater<>());
  return sizes;
}

TEST(Components, AgreeWithFloodFillOnNoise) {
  for (const double inside : {0.02, 0.06, 0.1, 0.5}) {
    std::mt19937 random(11);
    std::bernoulli_distribution is_inside(inside);
    const SparseVolume volume =
        sample_volume({3, 4, 5}, [&](const glm::dvec3&) { return is_inside(random) ? -1.0 : 1.0; });
    EXPECT_EQ(component_sizes(volume), flooded_sizes(volume)) << inside;
  }
}

TEST(Components, AgreeWithFloodFillOnUnstoredBricks) {
  std::mt19937 random(5);
  for (int round = 0; round < 20; ++round) {
    SparseVolume volume = sample_volume({3, 3, 3}, [](const glm::dvec3&) { return 9.0; });
    for (std::uint32_t& slot : volume.table)
      if (random() % 4 == 0) slot = SparseVolume::kInside;
    EXPECT_EQ(component_sizes(volume), flooded_sizes(volume));
  }
}

TEST(Components, CornersConnect) {
  SparseVolume volume = sample_volume(glm::ivec3(2), [](const glm::dvec3& p) {
    const bool inside = p == glm::dvec3(7) || p == glm::dvec3(8) || p == glm::dvec3(10, 8, 8);
    return inside ? -1.0 : 1.0;
  });
  EXPECT_EQ(component_sizes(volume), (std::vector<std::size_t>{2, 1}));
}

TEST(Components, OfNothing) {
  const SparseVolume volume = sample_volume(glm::ivec3(2), [](const glm::dvec3&) { return 1.0; });
  EXPECT_TRUE(component_sizes(volume).empty());
  SparseVolume copy = volume;
  EXPECT_EQ(remove_small_components(copy, 0.5).components, 0u);
  EXPECT_EQ(copy.distance, volume.distance);
}

TEST(Components, SpecksGoWithTheirShells) {
  const Distance body = sphere({40, 40, 40}, 18);
  const Distance speck = sphere({62.5, 60.5, 63.5}, 2.3);  // across bricks
  const glm::ivec3 bricks(10);
  SparseVolume volume =
      sample_volume(bricks, [&](const glm::dvec3& p) { return std::min(body(p), speck(p)); });
  const SparseVolume alone = sample_volume(bricks, body);
  const std::vector<std::size_t> sizes = component_sizes(volume);
  ASSERT_EQ(sizes.size(), 2u);

  const RemovedComponents removed = remove_small_components(volume, 0.01);
  EXPECT_EQ(removed.components, 1u);
  EXPECT_EQ(removed.voxels, sizes[1]);
  const glm::ivec3 size = volume.grid.voxels();
  for (int x = 0; x < size.x; ++x)
    for (int y = 0; y < size.y; ++y)
      for (int z = 0; z < size.z; ++z) ASSERT_EQ(volume.at({x, y, z}), alone.at({x, y, z}));
}

TEST(Components, UnstoredInsideBricksGoToo) {
  SparseVolume volume = sample_volume({9, 3, 3}, [](const glm::dvec3& p) {
    return std::min(box({4, 4, 4}, {19, 19, 19})(p), box({28, 2, 2}, {69, 21, 21})(p));
  });
  ASSERT_EQ(volume.table[volume.grid.brick_index({1, 1, 1})], SparseVolume::kInside);
  EXPECT_EQ(remove_small_components(volume, 0.5).components, 1u);
  EXPECT_EQ(component_sizes(volume).size(), 1u);
  EXPECT_EQ(volume.at({12, 12, 12}), SparseVolume::kBand);
  EXPECT_EQ(open_edges(extract_mesh(volume)), 0u);
}

TEST(Components, SmallOnesThatAreWantedStay) {
  const auto body = [](const glm::dvec3& p) {
    return std::min(
        {sphere({20, 20, 20}, 10)(p), sphere({40, 20, 20}, 1.5)(p), sphere({20, 40, 20}, 1.5)(p)});
  };
  SparseVolume volume = sample_volume({7, 7, 7}, body);
  ASSERT_EQ(component_sizes(volume).size(), 3u);
  int asked = 0;
  const RemovedComponents removed =
      remove_small_components(volume, 0.1, [&](std::span<const std::vector<glm::ivec3>> pieces) {
        ++asked;
        std::vector<bool> wanted;
        for (const auto& piece : pieces) {
          for (const glm::ivec3& voxel : piece) EXPECT_LT(volume.at(voxel), 0);
          wanted.push_back(piece.front().x > 30);
        }
        return wanted;
      });
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(removed.components, 1u);
  EXPECT_LT(volume.at({40, 20, 20}), 0);
  EXPECT_GT(volume.at({20, 40, 20}), 0);
  // Nobody is asked where nothing is small.
  remove_small_components(volume, 0, [&](std::span<const std::vector<glm::ivec3>> pieces) {
    ++asked;
    return std::vector<bool>(pieces.size());
  });
  EXPECT_EQ(asked, 1);
}

TEST(Components, KeepsWhatIsLargeEnough) {
  const auto two = [](const glm::dvec3& p) {
    return std::min(sphere({15, 15, 15}, 8)(p), sphere({45, 15, 15}, 7)(p));
  };
  SparseVolume volume = sample_volume({8, 4, 4}, two);
  EXPECT_EQ(remove_small_components(volume, 0.6).components, 0u);
  EXPECT_EQ(remove_small_components(volume, 1.0).components, 1u);
  EXPECT_THROW(remove_small_components(volume, 1.5), UsageError);
}

}  // namespace
}  // namespace photohull
