#include "volume/cavities.h"

#include <vector>

namespace photohull {
namespace {

using glm::ivec3;

ivec3 step(int axis, int side) {
  ivec3 out(0);
  out[axis] = side;
  return out;
}

/// Walks from the grid's border through bricks outside, whole, and through stored ones by voxels.
class Flood {
 public:
  explicit Flood(SparseVolume& volume)
      : volume_(volume),
        brick_reached_(volume.table.size(), false),
        reached_(volume.distance.size(), false) {}

  std::size_t run() {
    enter_from_border();
    while (!bricks_.empty() || !voxels_.empty()) {
      if (!bricks_.empty()) {
        const ivec3 brick = bricks_.back();
        bricks_.pop_back();
        for (int axis = 0; axis < 3; ++axis)
          for (const int side : {-1, 1}) enter_brick(brick + step(axis, side), axis, -side);
      } else {
        const std::size_t at = voxels_.back();
        voxels_.pop_back();
        step_from(at);
      }
    }
    return fill();
  }

 private:
  std::size_t fill() {
    std::size_t filled = 0;
    for (std::size_t i = 0; i < reached_.size(); ++i)
      if (!(volume_.distance[i] < 0) && !reached_[i]) {
        volume_.distance[i] = -SparseVolume::kBand;
        ++filled;
      }
    for (std::size_t i = 0; i < brick_reached_.size(); ++i)
      if (volume_.table[i] == SparseVolume::kOutside && !brick_reached_[i]) {
        volume_.table[i] = SparseVolume::kInside;
        filled += kBrickVoxels;
      }
    return filled;
  }

  void enter_from_border() {
    const ivec3 n = volume_.grid.bricks;
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (const int side : {-1, 1}) {
        ivec3 brick;
        brick[axis] = side < 0 ? 0 : n[axis] - 1;
        for (brick[v] = 0; brick[v] < n[v]; ++brick[v])
          for (brick[u] = 0; brick[u] < n[u]; ++brick[u]) enter_brick(brick, axis, side);
      }
    }
  }

  /// Enters a brick through its face towards `side` of an axis.
  void enter_brick(const ivec3& brick, int axis, int side) {
    if (brick[axis] < 0 || brick[axis] >= volume_.grid.bricks[axis]) return;
    const std::size_t index = volume_.grid.brick_index(brick);
    const std::uint32_t entry = volume_.table[index];
    if (entry == SparseVolume::kInside) return;
    if (entry == SparseVolume::kOutside) {
      if (brick_reached_[index]) return;
      brick_reached_[index] = true;
      bricks_.push_back(brick);
      return;
    }
    for (int i = 0; i < kBrickVoxels; ++i) {
      const ivec3 local(i >> 6, (i >> 3) & 7, i & 7);
      if (local[axis] == (side > 0 ? kBrickEdge - 1 : 0))
        enter_voxel(entry * std::size_t(kBrickVoxels) + std::size_t(i));
    }
  }

  void enter_voxel(std::size_t at) {
    if (volume_.distance[at] < 0 || reached_[at]) return;
    reached_[at] = true;
    voxels_.push_back(at);
  }

  void step_from(std::size_t at) {
    const int offset = int(at % kBrickVoxels);
    const ivec3 local(offset >> 6, (offset >> 3) & 7, offset & 7);
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        const ivec3 next = local + step(axis, side);
        if (next[axis] >= 0 && next[axis] < kBrickEdge)
          enter_voxel(at - std::size_t(offset) + std::size_t(voxel_offset(next)));
        else
          leave_brick(volume_.bricks[at / kBrickVoxels] + step(axis, side), next, axis, side);
      }
  }

  /// Steps into a neighbouring brick; `next` counts from the corner of the one that is left.
  void leave_brick(const ivec3& brick, const ivec3& next, int axis, int side) {
    if (brick[axis] < 0 || brick[axis] >= volume_.grid.bricks[axis]) return;
    const std::uint32_t entry = volume_.table[volume_.grid.brick_index(brick)];
    if (entry >= SparseVolume::kInside)
      enter_brick(brick, axis, -side);
    else
      enter_voxel(entry * std::size_t(kBrickVoxels) + std::size_t(voxel_offset(next & 7)));
  }

  SparseVolume& volume_;
  std::vector<bool> brick_reached_, reached_;
  std::vector<ivec3> bricks_;
  std::vector<std::size_t> voxels_;
};

}  // namespace

std::size_t fill_cavities(SparseVolume& volume) { return Flood(volume).run(); }

}  // namespace photohull
