#include "refine/voxel_set.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>

namespace photohull::refine {

VoxelSet sorted(const std::vector<VoxelSet>& parts) {
  VoxelSet all;
  for (const VoxelSet& part : parts) all.insert(all.end(), part.begin(), part.end());
  tbb::parallel_sort(all.begin(), all.end());
  return all;
}

VoxelSet around(std::span<const glm::vec3> points, const GridSpec& grid) {
  const Lattice lattice(grid);
  std::vector<VoxelSet> parts((points.size() + kVoxelSetPart - 1) / kVoxelSetPart);
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t part) {
    const std::size_t end = std::min(points.size(), (part + 1) * kVoxelSetPart);
    for (std::size_t i = part * kVoxelSetPart; i < end; ++i)
      for_block(lattice, nearest_voxel(glm::dvec3(points[i])),
                [&](const glm::ivec3& voxel) { parts[part].push_back(lattice.index(voxel)); });
  });
  VoxelSet out = sorted(parts);
  out.erase(std::unique(out.begin(), out.end()), out.end());
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
