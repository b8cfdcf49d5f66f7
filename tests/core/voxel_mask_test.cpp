#include "core/voxel_mask.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace photohull {
namespace {

TEST(VoxelMask, RanksWhatIsMarked) {
  VoxelMask mask(3);
  const std::vector<std::size_t> marked = {0, 5, 63, 64, 511, 512, 1023, 1100, 1535};
  for (const std::size_t voxel : marked) mask.mark(voxel);
  mask.count();
  EXPECT_EQ(mask.marked(), marked.size());
  EXPECT_EQ(mask.voxels(), 3u * kBrickVoxels);
  for (std::size_t voxel = 0; voxel < mask.voxels(); ++voxel) {
    const auto at = std::lower_bound(marked.begin(), marked.end(), voxel);
    EXPECT_EQ(mask.rank(voxel), std::size_t(at - marked.begin()));
    EXPECT_EQ(mask.has(voxel), at != marked.end() && *at == voxel);
  }
}

TEST(MaskedValues, ThoseOfTheMaskAndOneElsewhere) {
  const auto mask = std::make_shared<VoxelMask>(2);
  mask->mark(7), mask->mark(600);
  mask->count();
  MaskedValues<float> values(mask, 1, -1);
  values.ranked(1) = 4;
  EXPECT_EQ(values.size(), 2u * kBrickVoxels);
  EXPECT_EQ(values[6], -1);
  EXPECT_EQ(values[7], 1);
  EXPECT_EQ(values[600], 4);
  EXPECT_TRUE(MaskedValues<float>().empty() && MaskedValues<float>().size() == 0);
}

}  // namespace
}  // namespace photohull
