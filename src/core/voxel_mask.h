// Some voxels of a volume's stored bricks, and values for them alone.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/grid.h"

namespace photohull {

/// A set of voxels by their index in SparseVolume::distance.
class VoxelMask {
 public:
  explicit VoxelMask(std::size_t bricks = 0) : words_(bricks), first_(bricks) {}

  /// Different bricks may be marked by different threads.
  void mark(std::size_t voxel) {
    words_[voxel / kBrickVoxels][voxel % kBrickVoxels / 64] |= std::uint64_t(1) << (voxel % 64);
  }
  /// After the last mark, and before rank().
  void count() {
    count_ = 0;
    for (std::size_t b = 0; b < words_.size(); ++b) {
      first_[b] = count_;
      for (const std::uint64_t word : words_[b]) count_ += std::size_t(std::popcount(word));
    }
  }

  bool has(std::size_t voxel) const {
    return words_[voxel / kBrickVoxels][voxel % kBrickVoxels / 64] >> (voxel % 64) & 1;
  }
  /// How many voxels of the set come before a voxel.
  std::size_t rank(std::size_t voxel) const {
    const auto& words = words_[voxel / kBrickVoxels];
    const std::size_t last = voxel % kBrickVoxels / 64;
    std::size_t rank = first_[voxel / kBrickVoxels];
    for (std::size_t w = 0; w < last; ++w) rank += std::size_t(std::popcount(words[w]));
    const std::uint64_t before = (std::uint64_t(1) << (voxel % 64)) - 1;
    return rank + std::size_t(std::popcount(words[last] & before));
  }
  std::size_t voxels() const { return words_.size() * kBrickVoxels; }
  std::size_t marked() const { return count_; }

 private:
  std::vector<std::array<std::uint64_t, kBrickVoxels / 64>> words_;
  std::vector<std::size_t> first_;  // the rank of each brick's first voxel
  std::size_t count_ = 0;
};

/// Values at the voxels of a set; all others have one in common. Or empty.
template <typename T>
class MaskedValues {
 public:
  MaskedValues() = default;
  /// `initial` at the set's voxels, `elsewhere` at the others.
  MaskedValues(std::shared_ptr<const VoxelMask> mask, const T& initial, const T& elsewhere)
      : mask_(std::move(mask)), values_(mask_->marked(), initial), elsewhere_(elsewhere) {}

  bool empty() const { return !mask_; }
  /// Of all voxels of the bricks, in the set or not.
  std::size_t size() const { return mask_ ? mask_->voxels() : 0; }
  const T& operator[](std::size_t voxel) const {
    return mask_->has(voxel) ? values_[mask_->rank(voxel)] : elsewhere_;
  }
  /// By VoxelMask::rank.
  T& ranked(std::size_t rank) { return values_[rank]; }

 private:
  std::shared_ptr<const VoxelMask> mask_;
  std::vector<T> values_;
  T elsewhere_{};
};

}  // namespace photohull
