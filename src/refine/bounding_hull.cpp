#include "refine/bounding_hull.h"

#include <algorithm>

#include "core/error.h"

namespace photohull::refine {
namespace {

/// The bricks that hold some of a volume, and those around them.
std::vector<bool> bricks_about(const SparseVolume& volume) {
  const glm::ivec3 n = volume.grid.bricks;
  std::vector<bool> about(volume.table.size(), false);
  std::size_t index = 0;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) {
        if (volume.table[index++] == SparseVolume::kOutside) continue;
        const glm::ivec3 low = glm::max(glm::ivec3(x, y, z) - 1, 0);
        const glm::ivec3 high = glm::min(glm::ivec3(x, y, z) + 1, n - 1);
        for (int k = low.z; k <= high.z; ++k)
          for (int j = low.y; j <= high.y; ++j)
            for (int i = low.x; i <= high.x; ++i) about[volume.grid.brick_index({i, j, k})] = true;
      }
  return about;
}

}  // namespace

void BoundingHull::drop_far_from(const SparseVolume& volume) {
  PHOTOHULL_CHECK(volume.grid.bricks == hull_.grid.bricks);
  const std::vector<bool> about = bricks_about(volume);
  dropped_.resize(hull_.table.size(), false);
  SparseVolume kept;
  std::size_t count = 0;
  for (std::size_t i = 0; i < hull_.table.size(); ++i)
    count += about[i] && hull_.table[i] < SparseVolume::kInside;
  kept.bricks.reserve(count);
  kept.distance.reserve(count * kBrickVoxels);
  for (std::size_t i = 0; i < hull_.table.size(); ++i) {
    const std::uint32_t slot = hull_.table[i];
    if (slot >= SparseVolume::kInside) continue;
    if (!about[i]) {
      dropped_[i] = true;
      hull_.table[i] = SparseVolume::kOutside;
      continue;
    }
    hull_.table[i] = std::uint32_t(kept.bricks.size());
    kept.bricks.push_back(hull_.bricks[slot]);
    const auto from = hull_.distance.begin() + std::ptrdiff_t(slot) * kBrickVoxels;
    kept.distance.insert(kept.distance.end(), from, from + kBrickVoxels);
  }
  hull_.bricks = std::move(kept.bricks);
  hull_.distance = std::move(kept.distance);
}

bool BoundingHull::bounds(const SparseVolume& volume) const {
  for (std::size_t i = 0; i < dropped_.size(); ++i)
    if (dropped_[i] && volume.table[i] != SparseVolume::kOutside) return false;
  return true;
}

}  // namespace photohull::refine
