#include "refine/voxel_set.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <bit>

namespace photohull::refine {
namespace {

/// Voxels as bits of bricks. The lattice has a brick more on every side, for what lies beside it.
class BitBricks {
 public:
  explicit BitBricks(const GridSpec& grid)
      : n_(grid.bricks + 2),
        slot_of_(std::size_t(n_.x) * std::size_t(n_.y) * std::size_t(n_.z), kNone) {}

  /// The voxel nearest to a point, if that touches the lattice.
  void mark(const glm::vec3& point) {
    const glm::ivec3 voxel = nearest_voxel(glm::dvec3(point)) + kBrickEdge;
    if (glm::any(glm::lessThan(voxel, glm::ivec3(kBrickEdge - 1))) ||
        glm::any(glm::greaterThan(voxel, kBrickEdge * (n_ - 1))))
      return;
    std::uint32_t& slot = slot_of_[index(voxel / kBrickEdge)];
    if (slot == kNone) {
      slot = std::uint32_t(bits_.size());
      bits_.emplace_back();
    }
    bits_[slot][std::size_t(voxel.z & 7)] |= std::uint64_t(1)
                                             << (8 * (voxel.y & 7) + (voxel.x & 7));
  }

  /// The eight voxels along x of a row of a brick; y and z of the larger lattice.
  std::uint8_t row(int brick_x, int y, int z) const {
    const std::uint32_t slot = slot_of_[index({brick_x, y / kBrickEdge, z / kBrickEdge})];
    return slot == kNone ? 0 : std::uint8_t(bits_[slot][std::size_t(z & 7)] >> (8 * (y & 7)));
  }

  /// Is there anything in the bricks about this one along y and z?
  bool is_empty_about(const glm::ivec3& brick) const {
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        if (slot_of_[index(brick + glm::ivec3(0, y, z))] != kNone) return false;
    return true;
  }

  glm::ivec3 bricks() const { return n_; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  std::size_t index(const glm::ivec3& b) const {
    return (std::size_t(b.z) * std::size_t(n_.y) + std::size_t(b.y)) * std::size_t(n_.x) +
           std::size_t(b.x);
  }

  glm::ivec3 n_;
  std::vector<std::uint32_t> slot_of_;
  std::vector<std::array<std::uint64_t, kBrickEdge>> bits_;  // by z; y * 8 + x in each
};

/// Appends the voxels of a slice that are marked or beside marked ones; z of the lattice.
void take_slice(const BitBricks& marks, const Lattice& lattice, int z, VoxelSet& out) {
  const glm::ivec3 n = marks.bricks();
  std::vector<std::uint32_t> wide(
      static_cast<std::size_t>(n.x));  // a byte a brick, and its neighbours' bits
  for (int brick_y = 1; brick_y + 1 < n.y; ++brick_y) {
    std::vector<int> used;
    for (int x = 0; x < n.x; ++x)
      if (!marks.is_empty_about({x, brick_y, z / kBrickEdge + 1})) used.push_back(x);
    if (used.empty()) continue;
    for (int y = kBrickEdge * brick_y; y < kBrickEdge * (brick_y + 1); ++y) {
      std::fill(wide.begin(), wide.end(), 0u);
      for (const int x : used) {
        std::uint32_t bits = 0;
        for (int k = 0; k <= 2; ++k)
          for (int j = -1; j <= 1; ++j) bits |= marks.row(x, y + j, z + kBrickEdge - 1 + k);
        bits = bits << 1 | bits << 2 | bits;  // bit i + 1 is voxel i of the brick
        wide[std::size_t(x)] |= bits;
      }
      for (int x = 1; x + 1 < n.x; ++x) {
        std::uint32_t bits = wide[std::size_t(x)] >> 1 & 0xffu;
        bits |= wide[std::size_t(x - 1)] >> 9 & 1u;
        bits |= (wide[std::size_t(x + 1)] & 1u) << 7;
        for (; bits != 0; bits &= bits - 1)
          out.push_back(
              lattice.index({kBrickEdge * (x - 1) + std::countr_zero(bits), y - kBrickEdge, z}));
      }
    }
  }
}

}  // namespace

VoxelSet sorted(const std::vector<VoxelSet>& parts) {
  VoxelSet all;
  for (const VoxelSet& part : parts) all.insert(all.end(), part.begin(), part.end());
  tbb::parallel_sort(all.begin(), all.end());
  return all;
}

void for_around(std::span<const std::span<const glm::vec3>> points, const GridSpec& grid,
                const std::function<void(const VoxelSet&)>& take) {
  constexpr int kLayers = 4;  // of bricks, at once
  BitBricks marks(grid);
  for (const std::span<const glm::vec3> part : points)
    for (const glm::vec3& point : part) marks.mark(point);
  const Lattice lattice(grid);
  for (int layer = 0; layer < grid.bricks.z; layer += kLayers) {
    const int first = kBrickEdge * layer;
    std::vector<VoxelSet> slices(
        std::size_t(kBrickEdge * std::min(kLayers, grid.bricks.z - layer)));
    tbb::parallel_for(std::size_t(0), slices.size(), [&](std::size_t i) {
      take_slice(marks, lattice, first + int(i), slices[i]);
    });
    for (const VoxelSet& slice : slices)
      if (!slice.empty()) take(slice);
  }
}

VoxelSet around(std::span<const glm::vec3> points, const GridSpec& grid) {
  VoxelSet out;
  for_around(std::span(&points, 1), grid,
             [&](const VoxelSet& part) { out.insert(out.end(), part.begin(), part.end()); });
  return out;
}

bool contains(const VoxelSet& set, std::uint64_t index) {
  return std::binary_search(set.begin(), set.end(), index);
}

float& stored(const glm::ivec3& voxel, SparseVolume& volume) {
  std::uint32_t& entry = volume.table[volume.grid.brick_index(voxel / kBrickEdge)];
  if (entry >= SparseVolume::kInside) {
    const float all = entry == SparseVolume::kInside ? -SparseVolume::kBand : SparseVolume::kBand;
    entry = std::uint32_t(volume.bricks.size());
    volume.bricks.push_back(voxel / kBrickEdge);
    volume.distance.resize(volume.distance.size() + kBrickVoxels, all);
  }
  return volume.distance[std::size_t(entry) * kBrickVoxels + std::size_t(voxel_offset(voxel & 7))];
}

}  // namespace photohull::refine
