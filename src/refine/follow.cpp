#include "refine/follow.h"

#include <cstdint>

namespace photohull::refine {
namespace {

class Overlap {
 public:
  Overlap(const GridSpec& grid, const SparseVolume& hull) : grid_(grid), hull_(hull) {}

  /// `voxel` of the grid stands for `count` of them.
  void add(const glm::dvec3& voxel, std::int64_t count) {
    const glm::dvec3 at = (grid_.world(voxel) - hull_.grid.origin) / hull_.grid.voxel_size;
    const glm::ivec3 nearest(glm::round(at));
    const bool in_grid = glm::all(glm::greaterThanEqual(nearest, glm::ivec3(0))) &&
                         glm::all(glm::lessThan(nearest, hull_.grid.voxels()));
    all_ += count;
    if (in_grid && hull_.at(nearest) < 0) inside_ += count;
  }

  bool is_at_least(double share) const {
    return all_ > 0 && double(inside_) >= share * double(all_);
  }

 private:
  const GridSpec& grid_;
  const SparseVolume& hull_;
  std::int64_t all_ = 0, inside_ = 0;
};

}  // namespace

bool resembles(const SparseVolume& before, const SparseVolume& hull, const FollowOptions& options) {
  const glm::ivec3 n = before.grid.bricks;
  Overlap overlap(before.grid, hull);
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) {
        const glm::ivec3 corner = glm::ivec3(x, y, z) * kBrickEdge;
        const std::uint32_t slot = before.table[before.grid.brick_index({x, y, z})];
        if (slot == SparseVolume::kInside)
          overlap.add(glm::dvec3(corner) + 0.5 * (kBrickEdge - 1), kBrickVoxels);
        if (slot >= SparseVolume::kInside) continue;
        for (int v = 0; v < kBrickVoxels; ++v)
          if (before.distance[std::size_t(slot) * kBrickVoxels + std::size_t(v)] < 0)
            overlap.add(glm::dvec3(corner + glm::ivec3(v >> 6, (v >> 3) & 7, v & 7)), 1);
      }
  return overlap.is_at_least(options.least_inside);
}

}  // namespace photohull::refine
