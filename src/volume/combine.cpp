#include "volume/combine.h"

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
  const auto copy = [&](const SparseVolume& from, std::size_t index) {
    const float* values = from.distance.data() + std::size_t(from.table[index]) * kBrickVoxels;
    out.distance.insert(out.distance.end(), values, values + kBrickVoxels);
    out.bricks.push_back(from.bricks[from.table[index]]);
  };
  for (std::size_t i = 0; i < out.table.size(); ++i) {
    const std::uint32_t s = a.table[i], t = b.table[i];
    if (s == winner || t == winner) {
      out.table[i] = winner;
    } else if (s == neutral && t == neutral) {
      out.table[i] = neutral;
    } else {
      out.table[i] = std::uint32_t(out.bricks.size());
      copy(t == neutral ? a : b, i);
      if (s == neutral || t == neutral) continue;
      float* values = out.distance.data() + std::size_t(out.table[i]) * kBrickVoxels;
      const float* other = a.distance.data() + std::size_t(s) * kBrickVoxels;
      for (int v = 0; v < kBrickVoxels; ++v) values[v] = choose(values[v], other[v]);
    }
  }
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
