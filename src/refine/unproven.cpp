#include "refine/unproven.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstdint>

#include "core/disjoint_sets.h"

namespace photohull::refine {
namespace {

using glm::ivec3;

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr float kLeastDepth = 0.3f;  // voxels under the hull from where on space is hollow
constexpr float kAhead = 0.8f;       // voxels before a vertex: in what it looks into
constexpr int kPositions = 4;        // along the normal

/// The connected parts of the space under the hull that the volume leaves empty, as far as the
/// volume's bricks reach.
class Hollows {
 public:
  Hollows(const SparseVolume& hull, const SparseVolume& volume)
      : volume_(volume), part_(volume.distance.size(), kNone) {
    tbb::parallel_for(std::size_t(0), volume.bricks.size(), [&](std::size_t slot) {
      for (int i = 0; i < kBrickVoxels; ++i) {
        const std::size_t index = slot * kBrickVoxels + std::size_t(i);
        if (volume.distance[index] > 0 && hull.at(voxel_of(slot, i)) < -kLeastDepth)
          part_[index] = 0;
      }
    });
    std::uint32_t count = 0;
    for (std::uint32_t& part : part_)
      if (part != kNone) part = count++;
    sets_ = DisjointSets(count);
    for (std::size_t slot = 0; slot < volume.bricks.size(); ++slot)
      for (int i = 0; i < kBrickVoxels; ++i) {
        const std::uint32_t own = part_[slot * kBrickVoxels + std::size_t(i)];
        if (own == kNone) continue;
        for (int axis = 0; axis < 3; ++axis) {
          ivec3 step(0);
          step[axis] = 1;
          if (const std::uint32_t other = part(voxel_of(slot, i) + step); other != kNone)
            sets_.unite(own, other);
        }
      }
    for (std::uint32_t& part : part_)
      if (part != kNone) part = sets_.root(part);
  }

  std::size_t size() const { return sets_.size(); }
  ivec3 voxel_of(std::size_t slot, int i) const {
    return volume_.bricks[slot] * kBrickEdge + ivec3(i >> 6, (i >> 3) & 7, i & 7);
  }
  /// Which part the voxel belongs to, by a number below size(); kNone: none.
  std::uint32_t part(const ivec3& voxel) const {
    if (glm::any(glm::lessThan(voxel, ivec3(0))) ||
        glm::any(glm::greaterThanEqual(voxel, volume_.grid.voxels())))
      return kNone;
    const std::uint32_t slot = volume_.table[volume_.grid.brick_index(voxel / kBrickEdge)];
    if (slot >= volume_.bricks.size()) return kNone;
    return part_[std::size_t(slot) * kBrickVoxels + std::size_t(voxel_offset(voxel % kBrickEdge))];
  }
  std::uint32_t part(std::size_t index) const { return part_[index]; }

 private:
  const SparseVolume& volume_;
  std::vector<std::uint32_t> part_;  // of each voxel of the volume's bricks
  DisjointSets sets_;                // of the numbers
};

}  // namespace

std::size_t fill_unproven(const SparseVolume& hull, std::span<const glm::vec3> positions,
                          std::span<const glm::vec3> normals, std::span<const float> weights,
                          const UnprovenOptions& options, SparseVolume& volume) {
  if (options.least_weight == 0) return 0;
  const Hollows hollows(hull, volume);
  if (hollows.size() == 0) return 0;
  struct Sum {
    double weight = 0, count = 0, unseen = 0;
  };
  std::vector<Sum> sums(hollows.size());
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (int k = 0; k < kPositions; ++k) {
      const glm::vec3 ahead = positions[i] + kAhead * float(k) * normals[i];
      const std::uint32_t part = hollows.part(ivec3(glm::floor(ahead + 0.5f)));
      if (part == kNone) continue;
      sums[part].weight += std::max(weights[i], 0.0f);
      (weights[i] < 0 ? sums[part].unseen : sums[part].count) += 1;
      break;
    }
  const auto is_unproven = [&](std::uint32_t part) {
    return part != kNone && sums[part].unseen <= sums[part].count &&
           sums[part].weight < options.least_weight * sums[part].count;
  };
  std::atomic<std::size_t> filled = 0;
  tbb::parallel_for(std::size_t(0), volume.bricks.size(), [&](std::size_t slot) {
    std::size_t filled_here = 0;
    for (int i = 0; i < kBrickVoxels; ++i) {
      float& value = volume.distance[slot * kBrickVoxels + std::size_t(i)];
      if (!(value > 0)) continue;
      const ivec3 voxel = hollows.voxel_of(slot, i);
      const bool own = is_unproven(hollows.part(slot * kBrickVoxels + std::size_t(i)));
      bool beside = own;
      for (int n = 0; n < 27 && !beside; ++n)
        beside = is_unproven(hollows.part(voxel + ivec3(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1)));
      if (!beside) continue;
      const float bound = hull.at(voxel);
      if (!(bound < value)) continue;
      value = bound;
      filled_here += own;
    }
    filled += filled_here;
  });
  return filled;
}

}  // namespace photohull::refine
