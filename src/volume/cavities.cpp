#include "volume/cavities.h"

#include <tbb/parallel_for.h>

#include <array>
#include <cstdint>
#include <functional>
#include <numeric>
#include <vector>

namespace photohull {
namespace {

using glm::ivec3;

/// Voxels of a brick as bits: a word for each x, in it bit 8 y + z.
using Bits = std::array<std::uint64_t, kBrickEdge>;

constexpr std::uint64_t kLowZ = 0x0101010101010101u, kHighZ = kLowZ << (kBrickEdge - 1);
constexpr std::uint64_t kLowY = 0xffu, kHighY = kLowY << 56;
constexpr std::uint64_t kAll = ~std::uint64_t(0);

/// What of `open` the voxels of `reached` are joined with by faces within the brick.
void spread(const Bits& open, Bits& reached) {
  for (bool changed = true; changed;) {
    changed = false;
    for (int x = 0; x < kBrickEdge; ++x) {
      const std::size_t i = std::size_t(x);
      std::uint64_t now = reached[i];
      if (x > 0) now |= reached[i - 1] & open[i];
      if (x + 1 < kBrickEdge) now |= reached[i + 1] & open[i];
      for (std::uint64_t before = 0; before != now;) {
        before = now;
        now |= (now << 8 | now >> 8 | (now & ~kHighZ) << 1 | (now & ~kLowZ) >> 1) & open[i];
      }
      changed |= now != reached[i];
      reached[i] = now;
    }
  }
}

/// The voxels beyond a brick's face, of the brick there, that touch voxels of `from`.
Bits beyond(const Bits& from, int axis, int side) {
  Bits out{};
  if (axis == 0) {
    if (side > 0)
      out.front() = from.back();
    else
      out.back() = from.front();
    return out;
  }
  for (std::size_t x = 0; x < out.size(); ++x) {
    if (axis == 1)
      out[x] = side > 0 ? (from[x] & kHighY) >> 56 : (from[x] & kLowY) << 56;
    else
      out[x] = side > 0 ? (from[x] & kHighZ) >> 7 : (from[x] & kLowZ) << 7;
  }
  return out;
}

bool any(const Bits& bits) {
  return std::accumulate(bits.begin(), bits.end(), std::uint64_t(0), std::bit_or<>()) != 0;
}

/// Walks from the grid's border through what is outside, brick by brick.
class Flood {
 public:
  explicit Flood(SparseVolume& volume)
      : volume_(volume),
        open_(volume.bricks.size()),
        reached_(volume.bricks.size(), Bits{}),
        is_waiting_(volume.bricks.size(), 0),
        brick_reached_(volume.table.size(), 0) {
    tbb::parallel_for(std::size_t(0), open_.size(), [&](std::size_t slot) {
      const float* values = volume_.distance.data() + slot * kBrickVoxels;
      for (std::size_t x = 0; x < open_[slot].size(); ++x) {
        std::uint64_t word = 0;
        for (int i = 0; i < 64; ++i)
          word |= std::uint64_t(!(values[64 * x + std::size_t(i)] < 0)) << i;
        open_[slot][x] = word;
      }
    });
  }

  std::size_t run() {
    enter_from_border();
    while (!waiting_.empty()) {
      const ivec3 brick = waiting_.back();
      waiting_.pop_back();
      const std::uint32_t slot = volume_.table[volume_.grid.brick_index(brick)];
      Bits from;
      if (slot == SparseVolume::kOutside) {
        from.fill(kAll);
      } else {
        is_waiting_[slot] = 0;
        spread(open_[slot], reached_[slot]);
        from = reached_[slot];
      }
      for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
          ivec3 next = brick;
          next[axis] += side;
          if (next[axis] >= 0 && next[axis] < volume_.grid.bricks[axis])
            enter(next, beyond(from, axis, side));
        }
    }
    return fill();
  }

 private:
  std::size_t fill() {
    std::vector<std::size_t> filled(open_.size(), 0);
    tbb::parallel_for(std::size_t(0), open_.size(), [&](std::size_t slot) {
      float* values = volume_.distance.data() + slot * kBrickVoxels;
      for (std::size_t x = 0; x < open_[slot].size(); ++x) {
        const std::uint64_t closed = open_[slot][x] & ~reached_[slot][x];
        for (int i = 0; closed != 0 && i < 64; ++i)
          if (closed >> i & 1) {
            values[64 * x + std::size_t(i)] = -SparseVolume::kBand;
            ++filled[slot];
          }
      }
    });
    std::size_t count = std::accumulate(filled.begin(), filled.end(), std::size_t(0));
    for (std::size_t i = 0; i < brick_reached_.size(); ++i)
      if (volume_.table[i] == SparseVolume::kOutside && !brick_reached_[i]) {
        volume_.table[i] = SparseVolume::kInside;
        count += kBrickVoxels;
      }
    return count;
  }

  void enter_from_border() {
    Bits all;
    all.fill(kAll);
    const ivec3 n = volume_.grid.bricks;
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (const int side : {-1, 1}) {
        ivec3 brick;
        brick[axis] = side < 0 ? 0 : n[axis] - 1;
        for (brick[v] = 0; brick[v] < n[v]; ++brick[v])
          for (brick[u] = 0; brick[u] < n[u]; ++brick[u]) enter(brick, beyond(all, axis, -side));
      }
    }
  }

  /// Enters a brick at its voxels in `at`, as far as they are outside.
  void enter(const ivec3& brick, const Bits& at) {
    const std::size_t index = volume_.grid.brick_index(brick);
    const std::uint32_t slot = volume_.table[index];
    if (slot == SparseVolume::kInside) return;
    if (slot == SparseVolume::kOutside) {
      if (brick_reached_[index] || !any(at)) return;
      brick_reached_[index] = 1;
      waiting_.push_back(brick);
      return;
    }
    std::uint64_t fresh = 0;
    for (std::size_t x = 0; x < at.size(); ++x) {
      const std::uint64_t more = at[x] & open_[slot][x] & ~reached_[slot][x];
      reached_[slot][x] |= more;
      fresh |= more;
    }
    if (fresh == 0 || is_waiting_[slot]) return;
    is_waiting_[slot] = 1;
    waiting_.push_back(brick);
  }

  SparseVolume& volume_;
  std::vector<Bits> open_, reached_;         // by slot
  std::vector<std::uint8_t> is_waiting_;     // by slot
  std::vector<std::uint8_t> brick_reached_;  // by the table's index, of those outside
  std::vector<ivec3> waiting_;
};

}  // namespace

std::size_t fill_cavities(SparseVolume& volume) { return Flood(volume).run(); }

}  // namespace photohull
