#include "carving/bit_volume.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace photohull::carving {
namespace {

using glm::ivec3;

constexpr int kReach = 3;                         // voxels around a carved one that may change
constexpr int kWindow = kBrickEdge + 2 * kReach;  // a brick with its surroundings
constexpr float kSmoothLimit = 1.2f;              // voxels: beyond it the binomial filter saturates
constexpr float kSignGap = 0.15f;                 // voxels: least distance on the right side
constexpr float kBinomialSlope = 1 / 0.375f;  // voxels per unit of filtered occupancy at an edge

using Window = std::array<std::uint8_t, kWindow * kWindow * kWindow>;
using FloatWindow = std::array<float, kWindow * kWindow * kWindow>;

int window_index(int x, int y, int z) { return (x * kWindow + y) * kWindow + z; }

/// Occupancy around a brick; returns whether anything near was carved.
bool load_window(const SparseVolume& hull, const BitVolume& bits, const ivec3& brick, Window& out) {
  bool carved = false;
  const ivec3 low = brick * kBrickEdge - kReach;
  for (int x = 0; x < kWindow; ++x)
    for (int y = 0; y < kWindow; ++y)
      for (int z = 0; z < kWindow; ++z) {
        const ivec3 voxel = low + ivec3(x, y, z);
        const bool stands = bits.standing(voxel);
        out[window_index(x, y, z)] = stands;
        carved = carved || (!stands && hull.at(voxel) < 0);
      }
  return carved;
}

/// Binomial filter [1 4 6 4 1] / 16 along each axis.
void smooth(const Window& in, FloatWindow& out) {
  static constexpr float kWeights[5] = {1 / 16.f, 4 / 16.f, 6 / 16.f, 4 / 16.f, 1 / 16.f};
  FloatWindow other;
  std::copy(in.begin(), in.end(), out.begin());
  const int strides[3] = {kWindow * kWindow, kWindow, 1};
  for (const int stride : strides) {
    for (int i = 0; i < int(out.size()); ++i) {
      const int at = i / stride % kWindow;
      float sum = 0;
      for (int tap = -2; tap <= 2; ++tap)
        sum += kWeights[tap + 2] * out[i + (std::clamp(at + tap, 0, kWindow - 1) - at) * stride];
      other[i] = sum;
    }
    out.swap(other);
  }
}

/// Distance in voxels from a voxel to the nearest centre on the other side, at most kReach.
float distance_to_other_side(const Window& window, int x, int y, int z) {
  const std::uint8_t own = window[window_index(x, y, z)];
  int best = kReach * kReach;
  for (int dx = -kReach; dx <= kReach; ++dx)
    for (int dy = -kReach; dy <= kReach; ++dy)
      for (int dz = -kReach; dz <= kReach; ++dz) {
        const int squared = dx * dx + dy * dy + dz * dz;
        if (squared < best && window[window_index(x + dx, y + dy, z + dz)] != own) best = squared;
      }
  return std::sqrt(float(best));
}

float carved_value(const Window& window, const FloatWindow& filtered, int x, int y, int z) {
  const bool stands = window[window_index(x, y, z)];
  const float value = (0.5f - filtered[window_index(x, y, z)]) * kBinomialSlope;
  if (std::abs(value) >= kSmoothLimit) {
    const float distance = std::max(kSmoothLimit, distance_to_other_side(window, x, y, z) - 0.5f);
    return stands ? -distance : distance;
  }
  return stands ? std::min(value, -kSignGap) : std::max(value, kSignGap);
}

void store(SparseVolume& out, const ivec3& brick, const std::array<float, kBrickVoxels>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  std::uint32_t& slot = out.table[out.grid.brick_index(brick)];
  if (*low > 1 || *high < -1) {
    slot = *low > 0 ? SparseVolume::kOutside : SparseVolume::kInside;
    return;
  }
  slot = std::uint32_t(out.bricks.size());
  out.bricks.push_back(brick);
  out.distance.insert(out.distance.end(), values.begin(), values.end());
}

}  // namespace

bool BitVolume::standing(const ivec3& voxel) const {
  const ivec3 size = grid.voxels();
  for (int axis = 0; axis < 3; ++axis)
    if (voxel[axis] < 0 || voxel[axis] >= size[axis]) return false;
  const std::uint32_t slot = table[grid.brick_index(voxel / kBrickEdge)];
  if (slot == SparseVolume::kOutside) return false;
  const int offset = voxel_offset(voxel % kBrickEdge);
  return words[std::size_t(slot) * kWords + offset / 32] >> (offset % 32) & 1;
}

void BitVolume::clear(const ivec3& voxel) {
  const std::uint32_t slot = table[grid.brick_index(voxel / kBrickEdge)];
  const int offset = voxel_offset(voxel % kBrickEdge);
  words[std::size_t(slot) * kWords + offset / 32] &= ~(1u << (offset % 32));
}

BitVolume to_bits(const SparseVolume& volume) {
  BitVolume bits;
  bits.grid = volume.grid;
  bits.table.assign(volume.table.size(), SparseVolume::kOutside);
  const ivec3 count = volume.grid.bricks;
  for (int z = 0; z < count.z; ++z)
    for (int y = 0; y < count.y; ++y)
      for (int x = 0; x < count.x; ++x) {
        const std::size_t index = volume.grid.brick_index({x, y, z});
        const std::uint32_t slot = volume.table[index];
        if (slot == SparseVolume::kOutside) continue;
        bits.table[index] = std::uint32_t(bits.bricks.size());
        bits.bricks.push_back({x, y, z});
        const std::size_t first = bits.words.size();
        bits.words.resize(first + BitVolume::kWords, slot == SparseVolume::kInside ? ~0u : 0u);
        if (slot == SparseVolume::kInside) continue;
        const float* distance = &volume.distance[std::size_t(slot) * kBrickVoxels];
        for (int i = 0; i < kBrickVoxels; ++i)
          if (distance[i] < 0) bits.words[first + i / 32] |= 1u << (i % 32);
      }
  return bits;
}

SparseVolume carved_distance(const SparseVolume& hull, const BitVolume& bits) {
  SparseVolume out;
  out.grid = hull.grid;
  out.table = hull.table;
  Window window;
  FloatWindow filtered;
  std::array<float, kBrickVoxels> values;
  for (const ivec3& brick : bits.bricks) {
    const std::uint32_t slot = hull.table[hull.grid.brick_index(brick)];
    const bool carved = load_window(hull, bits, brick, window);
    if (!carved && slot == SparseVolume::kInside) continue;
    if (carved) smooth(window, filtered);
    for (int x = 0; x < kBrickEdge; ++x)
      for (int y = 0; y < kBrickEdge; ++y)
        for (int z = 0; z < kBrickEdge; ++z) {
          float& value = values[voxel_offset({x, y, z})];
          value = hull.at(brick * kBrickEdge + ivec3(x, y, z));
          if (carved)
            value =
                std::max(value, carved_value(window, filtered, x + kReach, y + kReach, z + kReach));
        }
    store(out, brick, values);
  }
  return out;
}

}  // namespace photohull::carving
