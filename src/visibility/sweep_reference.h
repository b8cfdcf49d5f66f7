// The sweep's tests of visibility in plain double precision.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <span>

#include "projtex/gpu_views.h"
#include "shared/depth_map.h"
#include "visibility/sweep_test.h"

namespace photohull::visibility::reference {

/// What the sweep has passed: drawn into a map, and voxel by voxel.
struct Passed {
  shaders::DepthMapInfo info;
  std::span<const double> depths;                ///< row-major, as `info` says
  std::function<bool(const glm::ivec3&)> voxel;  ///< false outside the grid
  glm::ivec3 voxels{0};                          ///< of the grid
};

/// The share of the part around `voxel` of a layer across `axis` that the camera sees, as
/// include/sweep_visibility.glsl; `bias` in voxels.
double sweep_visible(SweepTest test, const projtex::GridCamera& camera, int axis,
                     const glm::dvec3& voxel, double bias, const Passed& passed);

}  // namespace photohull::visibility::reference
