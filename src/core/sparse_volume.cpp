#include "core/grid.h"

namespace photohull {

Box GridSpec::bounds() const {
  const glm::dvec3 low = origin - 0.5 * voxel_size;
  return {low, low + voxel_size * glm::dvec3(voxels())};
}

float SparseVolume::at(const glm::ivec3& voxel) const {
  const glm::ivec3 size = grid.voxels();
  for (int axis = 0; axis < 3; ++axis)
    if (voxel[axis] < 0 || voxel[axis] >= size[axis]) return kBand;
  const std::uint32_t slot = table[grid.brick_index(voxel / kBrickEdge)];
  if (slot == kOutside) return kBand;
  if (slot == kInside) return -kBand;
  return distance[std::size_t(slot) * kBrickVoxels + voxel_offset(voxel % kBrickEdge)];
}

double SparseVolume::interpolated(const glm::dvec3& p) const {
  const glm::dvec3 low = glm::floor(p), share = p - low;
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 step(corner & 1, (corner >> 1) & 1, corner >> 2);
    const glm::dvec3 w = glm::mix(1.0 - share, share, glm::dvec3(step));
    sum += w.x * w.y * w.z * double(at(glm::ivec3(low) + step));
  }
  return sum;
}

std::size_t SparseVolume::inside_voxels() const {
  std::size_t count = 0;
  for (const std::uint32_t slot : table) count += slot == kInside ? kBrickVoxels : 0;
  for (const float d : distance) count += d < 0;
  return count;
}

}  // namespace photohull
