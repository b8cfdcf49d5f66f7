#include "core/grid.h"

namespace photohull {

Box GridSpec::bounds() const {
  const glm::dvec3 low = origin - 0.5 * voxel_size;
  return {low, low + voxel_size * glm::dvec3(voxels())};
}

float SparseVolume::at(const glm::ivec3& voxel) const {
  const glm::uvec3 at(voxel), size(grid.voxels());  // what is below 0 becomes large
  if (at.x >= size.x || at.y >= size.y || at.z >= size.z) return kBand;
  const std::uint32_t slot = table[grid.brick_index(voxel / kBrickEdge)];
  if (slot == kOutside) return kBand;
  if (slot == kInside) return -kBand;
  return distance[std::size_t(slot) * kBrickVoxels + std::size_t(voxel_offset(voxel & 7))];
}

double SparseVolume::interpolated(const glm::dvec3& p) const {
  const glm::dvec3 low = glm::floor(p), share = p - low, rest = 1.0 - share;
  const glm::ivec3 voxel(low), local = voxel & 7;
  std::array<float, 8> corners;  // x fastest
  const glm::uvec3 at(voxel), size(grid.voxels());
  if (at.x < size.x && at.y < size.y && at.z < size.z && local.x < 7 && local.y < 7 &&
      local.z < 7) {  // all of them in one brick
    const std::uint32_t slot = table[grid.brick_index(voxel / kBrickEdge)];
    if (slot == kOutside) return kBand;
    if (slot == kInside) return -kBand;
    const float* first =
        distance.data() + std::size_t(slot) * kBrickVoxels + std::size_t(voxel_offset(local));
    constexpr int kX = 64, kY = 8, kZ = 1;
    corners = {first[0],  first[kX],      first[kY],      first[kX + kY],
               first[kZ], first[kX + kZ], first[kY + kZ], first[kX + kY + kZ]};
  } else {
    for (int corner = 0; corner < 8; ++corner)
      corners[std::size_t(corner)] =
          this->at(voxel + glm::ivec3(corner & 1, (corner >> 1) & 1, corner >> 2));
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner)
    sum += (corner & 1 ? share.x : rest.x) * (corner & 2 ? share.y : rest.y) *
           (corner & 4 ? share.z : rest.z) * double(corners[std::size_t(corner)]);
  return sum;
}

std::size_t SparseVolume::inside_voxels() const {
  std::size_t count = 0;
  for (const std::uint32_t slot : table) count += slot == kInside ? kBrickVoxels : 0;
  for (const float d : distance) count += d < 0;
  return count;
}

}  // namespace photohull
