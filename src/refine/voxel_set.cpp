#include "refine/voxel_set.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <bit>

namespace photohull::refine {
namespace {

/// The voxels nearest to points, by their slices across z; what touches the lattice or lies in it.
class SlicedPoints {
 public:
  SlicedPoints(std::span<const glm::vec3> points, const glm::ivec3& n)
      : first_(std::size_t(n.z) + 3) {
    const auto visit = [&](auto&& f) {
      for (const glm::vec3& point : points) {
        const glm::ivec3 middle = nearest_voxel(glm::dvec3(point));
        if (glm::all(glm::greaterThanEqual(middle, glm::ivec3(-1))) &&
            glm::all(glm::lessThanEqual(middle, n)))
          f(std::size_t(middle.z + 1), glm::ivec2(middle));
      }
    };
    visit([&](std::size_t slice, const glm::ivec2&) { ++first_[slice + 1]; });
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    places_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    visit([&](std::size_t slice, const glm::ivec2& place) { places_[next[slice]++] = place; });
  }

  /// z from -1 to the number of slices.
  std::span<const glm::ivec2> of(int z) const {
    const auto slice = std::size_t(z + 1);
    return std::span(places_).subspan(first_[slice], first_[slice + 1] - first_[slice]);
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<glm::ivec2> places_;
};

/// A set of voxels of one slice, as bits.
class Slice {
 public:
  explicit Slice(const glm::ivec3& n)
      : n_(n), words_((n.x + 63) / 64), row_used_(std::size_t(n.y)) {
    bits_.resize(std::size_t(words_) * std::size_t(n.y));
  }

  void mark_around(const glm::ivec2& middle) {
    const glm::ivec2 low = glm::max(middle - 1, 0);
    const glm::ivec2 high = glm::min(middle + 1, glm::ivec2(n_) - 1);
    for (int y = low.y; y <= high.y; ++y) {
      row_used_[std::size_t(y)] = 1;
      for (int x = low.x; x <= high.x; ++x) row(y)[x / 64] |= std::uint64_t(1) << (x % 64);
    }
  }

  /// Appends what is marked, and forgets it.
  void take(int z, VoxelSet& out) {
    const Lattice lattice(n_);
    for (int y = 0; y < n_.y; ++y) {
      if (!row_used_[std::size_t(y)]) continue;
      for (int w = 0; w < words_; ++w) {
        for (std::uint64_t left = row(y)[w]; left != 0; left &= left - 1)
          out.push_back(lattice.index({64 * w + std::countr_zero(left), y, z}));
        row(y)[w] = 0;
      }
      row_used_[std::size_t(y)] = 0;
    }
  }

 private:
  std::uint64_t* row(int y) { return bits_.data() + std::size_t(y) * std::size_t(words_); }

  glm::ivec3 n_;
  int words_;
  std::vector<std::uint64_t> bits_;
  std::vector<std::uint8_t> row_used_;
};

}  // namespace

VoxelSet sorted(const std::vector<VoxelSet>& parts) {
  VoxelSet all;
  for (const VoxelSet& part : parts) all.insert(all.end(), part.begin(), part.end());
  tbb::parallel_sort(all.begin(), all.end());
  return all;
}

VoxelSet around(std::span<const glm::vec3> points, const GridSpec& grid) {
  const glm::ivec3 n = grid.voxels();
  const SlicedPoints sliced(points, n);
  constexpr int kSlices = 8;  // that a task takes
  std::vector<VoxelSet> parts(std::size_t((n.z + kSlices - 1) / kSlices));
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t part) {
    Slice slice(n);
    const int end = std::min(n.z, int(part + 1) * kSlices);
    for (int z = int(part) * kSlices; z < end; ++z) {
      for (int beside = z - 1; beside <= z + 1; ++beside)
        for (const glm::ivec2& middle : sliced.of(beside)) slice.mark_around(middle);
      slice.take(z, parts[part]);
    }
  });
  std::size_t size = 0;
  for (const VoxelSet& part : parts) size += part.size();
  VoxelSet out;
  out.reserve(size);
  for (VoxelSet& part : parts) {
    out.insert(out.end(), part.begin(), part.end());
    VoxelSet().swap(part);
  }
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
