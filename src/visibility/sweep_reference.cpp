#include "visibility/sweep_reference.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace photohull::visibility::reference {
namespace {

using glm::dvec2;
using glm::dvec3;
using glm::ivec3;

constexpr double kSteepestLayer = 4;

/// Depth at which a map position's ray meets the layer; infinite behind the camera.
double depth_on_layer(const projtex::GridCamera& camera, double scale, int axis, const dvec3& voxel,
                      const dvec2& at) {
  const glm::dmat4x3& p = camera.projection;
  const dvec3 ray = glm::inverse(glm::dmat3(p[0], p[1], p[2])) * dvec3(at / scale - 0.5, 1);
  const double depth = (voxel[axis] - camera.centre[axis]) / ray[axis];
  return depth > 0 ? depth : std::numeric_limits<double>::infinity();
}

double by_rays(const projtex::GridCamera& camera, const dvec3& voxel, double bias,
               const Passed& passed) {
  const double depth = (camera.projection * glm::dvec4(voxel, 1)).z;
  const dvec3 ray = camera.centre - voxel, origin = voxel + 0.5;
  double t = bias / depth;
  ivec3 cell(glm::floor(origin + t * ray));
  while (t < 1) {
    for (int i = 0; i < 3; ++i)
      if (cell[i] < 0 || cell[i] >= passed.voxels[i]) return 1;
    if (passed.voxel(cell)) return 0;
    double next = std::numeric_limits<double>::infinity();
    int through = 0;
    for (int i = 0; i < 3; ++i) {
      if (ray[i] == 0) continue;
      const double wall = (cell[i] + (ray[i] > 0) - origin[i]) / ray[i];
      if (wall < next) next = wall, through = i;
    }
    t = next;
    cell[through] += ray[through] > 0 ? 1 : -1;
  }
  return 1;
}

}  // namespace

double sweep_visible(SweepTest test, const projtex::GridCamera& camera, int axis,
                     const dvec3& voxel, double bias, const Passed& passed) {
  if (test == SweepTest::kRays) return by_rays(camera, voxel, bias, passed);
  const dvec3 p = camera.projection * glm::dvec4(voxel, 1);
  const shaders::DepthMapInfo& info = passed.info;
  const double scale = info.scale.x;
  const dvec2 at = (dvec2(p) / p.z + 0.5) * scale;
  const bool aligned = test == SweepTest::kVirtual || test == SweepTest::kPcfVirtual;
  const int radius = test == SweepTest::kPcf || test == SweepTest::kPcfVirtual ? 1 : 0;
  if (test == SweepTest::kReceiverPlane) {
    double change = 0;
    for (const dvec2& step : {dvec2(1e-5, 0), dvec2(0, 1e-5)})
      change += 0.5 * std::abs(depth_on_layer(camera, scale, axis, voxel, at + step) - p.z) / 1e-5;
    bias += std::min(change, kSteepestLayer);
  }
  int passes = 0, taps = 0;
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x, ++taps) {
      const int i = std::clamp(int(std::floor(at.x)) + x, 0, info.size.x - 1);
      const int j = std::clamp(int(std::floor(at.y)) + y, 0, info.size.y - 1);
      double depth = p.z;
      if (aligned) {
        const dvec2 middle(i + 0.5, j + 0.5), away = glm::abs(middle - at);
        const double most = kSteepestLayer * (away.x + away.y);
        depth =
            std::clamp(depth_on_layer(camera, scale, axis, voxel, middle), p.z - most, p.z + most);
      }
      passes += depth <= passed.depths[std::size_t(j) * info.size.x + i] + bias;
    }
  return double(passes) / taps;
}

}  // namespace photohull::visibility::reference
