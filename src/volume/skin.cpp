#include "volume/skin.h"

namespace photohull {

std::vector<glm::ivec3> skin(const SparseVolume& volume) {
  std::vector<glm::ivec3> voxels;
  for (std::size_t slot = 0; slot < volume.bricks.size(); ++slot)
    for (int i = 0; i < kBrickVoxels; ++i) {
      const float d = volume.distance[slot * kBrickVoxels + std::size_t(i)];
      if (d <= 0 && d > -1)
        voxels.push_back(volume.bricks[slot] * kBrickEdge +
                         glm::ivec3(i >> 6, (i >> 3) & 7, i & 7));
    }
  return voxels;
}

}  // namespace photohull
