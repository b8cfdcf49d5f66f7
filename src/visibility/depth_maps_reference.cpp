#include <algorithm>
#include <cmath>

#include "visibility/kernels/depth_maps.h"

namespace photohull::visibility::reference {

void splat_voxel(const projtex::GridCamera& camera, const shaders::DepthMapInfo& info,
                 const glm::ivec3& voxel, std::vector<double>& depths) {
  const glm::dvec3 p = camera.projection * glm::dvec4(voxel, 1);
  if (p.z <= 1) return;
  const double scale = info.scale.x;
  const double half = 0.5 * camera.focal / p.z * scale;
  const double cx = (p.x / p.z + 0.5) * scale, cy = (p.y / p.z + 0.5) * scale;
  for (int y = 0; y < info.size.y; ++y)
    for (int x = 0; x < info.size.x; ++x) {
      // The texel's square [x, x + 1) against the voxel's.
      const bool touches =
          x + 1 > cx - half && x <= cx + half && y + 1 > cy - half && y <= cy + half;
      double& depth = depths[std::size_t(y) * info.size.x + x];
      if (touches) depth = std::min(depth, p.z);
    }
}

bool visible(const projtex::GridCamera& camera, const shaders::DepthMapInfo& info,
             const glm::dvec3& point, double bias, std::span<const double> depths) {
  const glm::dvec3 p = camera.projection * glm::dvec4(point, 1);
  const int x = std::clamp(int((p.x / p.z + 0.5) * info.scale.x), 0, info.size.x - 1);
  const int y = std::clamp(int((p.y / p.z + 0.5) * info.scale.x), 0, info.size.y - 1);
  return p.z <= depths[std::size_t(y) * info.size.x + x] + bias;
}

}  // namespace photohull::visibility::reference
