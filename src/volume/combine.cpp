#include "volume/combine.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "core/error.h"

namespace photohull {
namespace {

/// Voxel by voxel `choose` of the two distances; bricks that are `winner` in either are so in the
/// result, and where one is `neutral` the other stands.
template <typename F>
SparseVolume combine(const SparseVolume& a, const SparseVolume& b, std::uint32_t winner,
                     std::uint32_t neutral, F&& choose) {
  PHOTOHULL_CHECK(a.grid.bricks == b.grid.bricks);
  SparseVolume out;
  out.grid = a.grid;
  out.table.resize(a.table.size());
  std::vector<std::size_t> stored;  // where in the table
  for (std::size_t i = 0; i < out.table.size(); ++i) {
    const std::uint32_t s = a.table[i], t = b.table[i];
    if (s == winner || t == winner) {
      out.table[i] = winner;
    } else if (s == neutral && t == neutral) {
      out.table[i] = neutral;
    } else {
      out.table[i] = std::uint32_t(stored.size());
      stored.push_back(i);
    }
  }
  out.bricks.resize(stored.size());
  out.distance.resize(stored.size() * kBrickVoxels);
  tbb::parallel_for(std::size_t(0), stored.size(), [&](std::size_t slot) {
    const std::uint32_t s = a.table[stored[slot]], t = b.table[stored[slot]];
    const SparseVolume& from = t == neutral ? a : b;
    const std::size_t first = std::size_t(t == neutral ? s : t) * kBrickVoxels;
    float* values = out.distance.data() + slot * kBrickVoxels;
    std::copy_n(from.distance.data() + first, kBrickVoxels, values);
    out.bricks[slot] = from.bricks[first / kBrickVoxels];
    if (s == neutral || t == neutral) return;
    const float* other = a.distance.data() + std::size_t(s) * kBrickVoxels;
    for (int v = 0; v < kBrickVoxels; ++v) values[v] = choose(values[v], other[v]);
  });
  return out;
}

}  // namespace

SparseVolume intersection(const SparseVolume& a, const SparseVolume& b) {
  return combine(a, b, SparseVolume::kOutside, SparseVolume::kInside,
                 [](float x, float y) { return std::max(x, y); });
}

SparseVolume union_of(const SparseVolume& a, const SparseVolume& b) {
  return combine(a, b, SparseVolume::kInside, SparseVolume::kOutside,
                 [](float x, float y) { return std::min(x, y); });
}

}  // namespace photohull
