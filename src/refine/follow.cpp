#include "refine/follow.h"

#include <cstdint>

namespace photohull::refine {
namespace {

constexpr float kNear = 1;  // voxels of the hull's grid

/// Of what was solid: voxels in all, in the hull, and in it or near it.
class Overlap {
 public:
  Overlap(const GridSpec& grid, const SparseVolume& hull) : grid_(grid), hull_(hull) {}

  /// `voxel` of the grid stands for `count` of them.
  void add(const glm::dvec3& voxel, std::int64_t count) {
    const glm::dvec3 at = (grid_.world(voxel) - hull_.grid.origin) / hull_.grid.voxel_size;
    const float distance = hull_.at(glm::ivec3(glm::round(at)));
    all_ += count;
    if (distance < 0) inside_ += count;
    if (distance < kNear) near_ += count;
  }

  bool has_inside(double share) const {
    return all_ > 0 && double(inside_) >= share * double(all_);
  }
  bool has_near(double share) const { return all_ > 0 && double(near_) >= share * double(all_); }

 private:
  const GridSpec& grid_;
  const SparseVolume& hull_;
  std::int64_t all_ = 0, inside_ = 0, near_ = 0;
};

Overlap overlap(const SparseVolume& before, const SparseVolume& hull) {
  const glm::ivec3 n = before.grid.bricks;
  Overlap out(before.grid, hull);
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) {
        const glm::ivec3 corner = glm::ivec3(x, y, z) * kBrickEdge;
        const std::uint32_t slot = before.table[before.grid.brick_index({x, y, z})];
        if (slot == SparseVolume::kInside)
          out.add(glm::dvec3(corner) + 0.5 * (kBrickEdge - 1), kBrickVoxels);
        if (slot >= SparseVolume::kInside) continue;
        for (int v = 0; v < kBrickVoxels; ++v)
          if (before.distance[std::size_t(slot) * kBrickVoxels + std::size_t(v)] < 0)
            out.add(glm::dvec3(corner + glm::ivec3(v >> 6, (v >> 3) & 7, v & 7)), 1);
      }
  return out;
}

}  // namespace

int levels_from(const MomentBefore& before, const SparseVolume& hull,
                const FollowOptions& options) {
  const Overlap shared = overlap(before.surface, hull);
  if (!shared.has_inside(options.least_inside)) return 0;
  const bool still = before.followed && shared.has_near(options.again_least_near);
  return still ? options.again_levels : options.levels;
}

}  // namespace photohull::refine
