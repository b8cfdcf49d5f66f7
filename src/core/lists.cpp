#include "core/lists.h"

#include <cmath>

namespace photohull {
namespace {

void check(const SparseVolume& volume) {
  bool ok = volume.table.size() == volume.grid.brick_count() &&
            volume.distance.size() == volume.bricks.size() * kBrickVoxels;
  for (std::size_t slot = 0; ok && slot < volume.bricks.size(); ++slot) {
    const glm::ivec3& b = volume.bricks[slot];
    ok = glm::all(glm::greaterThanEqual(b, glm::ivec3(0))) &&
         glm::all(glm::lessThan(b, volume.grid.bricks)) &&
         volume.table[volume.grid.brick_index(b)] == slot;
  }
  for (std::size_t i = 0; ok && i < volume.table.size(); ++i)
    ok = volume.table[i] >= SparseVolume::kInside || volume.table[i] < volume.bricks.size();
  for (std::size_t i = 0; ok && i < volume.distance.size(); ++i)
    ok = std::abs(volume.distance[i]) <= SparseVolume::kBand;
  if (!ok) throw Error("its volume contradicts itself");
}

}  // namespace

void write_volume(const SparseVolume& volume, ListWriter& to) {
  to.one(volume.grid);
  to.list(volume.table);
  to.list(volume.bricks);
  to.list(volume.distance);
}

SparseVolume read_volume(ListReader& from) {
  SparseVolume out;
  out.grid = from.one<GridSpec>();
  out.table = from.list<std::uint32_t>();
  out.bricks = from.list<glm::ivec3>();
  out.distance = from.list<float>();
  check(out);
  return out;
}

}  // namespace photohull
