#include "volume/cavities.h"

#include <vector>

namespace photohull {
namespace {

class Flood {
 public:
  explicit Flood(SparseVolume& volume) : volume_(volume), reached_(volume.distance.size(), false) {}

  std::size_t run() {
    for (std::size_t slot = 0; slot < volume_.bricks.size(); ++slot) enter_from_outside(slot);
    while (!front_.empty()) {
      const std::size_t at = front_.back();
      front_.pop_back();
      step_from(at);
    }
    std::size_t filled = 0;
    for (std::size_t i = 0; i < reached_.size(); ++i)
      if (volume_.distance[i] > 0 && !reached_[i]) {
        volume_.distance[i] = -SparseVolume::kBand;
        ++filled;
      }
    return filled;
  }

 private:
  bool is_outside(const glm::ivec3& brick) const {
    for (int axis = 0; axis < 3; ++axis)
      if (brick[axis] < 0 || brick[axis] >= volume_.grid.bricks[axis]) return true;
    return volume_.table[volume_.grid.brick_index(brick)] == SparseVolume::kOutside;
  }

  void enter(std::size_t at) {
    if (volume_.distance[at] <= 0 || reached_[at]) return;
    reached_[at] = true;
    front_.push_back(at);
  }

  void enter_from_outside(std::size_t slot) {
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        glm::ivec3 step(0);
        step[axis] = side;
        if (!is_outside(volume_.bricks[slot] + step)) continue;
        for (int i = 0; i < kBrickVoxels; ++i) {
          const glm::ivec3 local(i >> 6, (i >> 3) & 7, i & 7);
          if (local[axis] == (side > 0 ? kBrickEdge - 1 : 0))
            enter(slot * kBrickVoxels + std::size_t(i));
        }
      }
  }

  void step_from(std::size_t at) {
    const std::size_t slot = at / kBrickVoxels;
    const int offset = int(at % kBrickVoxels);
    const glm::ivec3 local(offset >> 6, (offset >> 3) & 7, offset & 7);
    constexpr int kStride[] = {64, 8, 1};
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        const int next = local[axis] + side;
        if (next >= 0 && next < kBrickEdge) {
          enter(std::size_t(std::ptrdiff_t(at) + side * kStride[axis]));
          continue;
        }
        glm::ivec3 brick = volume_.bricks[slot];
        brick[axis] += side;
        if (is_outside(brick)) continue;
        const std::uint32_t entry = volume_.table[volume_.grid.brick_index(brick)];
        if (entry == SparseVolume::kInside) continue;
        enter(std::size_t(std::ptrdiff_t(entry * std::size_t(kBrickVoxels)) + offset -
                          side * (kBrickEdge - 1) * kStride[axis]));
      }
  }

  SparseVolume& volume_;
  std::vector<bool> reached_;
  std::vector<std::size_t> front_;
};

}  // namespace

std::size_t fill_cavities(SparseVolume& volume) { return Flood(volume).run(); }

}  // namespace photohull
