// The photographs of a scene, with what their pixels are worth.
#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "core/depth_map.h"
#include "core/grid.h"
#include "projtex/gpu_views.h"
#include "projtex/image_set.h"

namespace photohull::projtex {

/// Images and cameras are in the same order and outlive the object.
struct Photographs {
  const ImageSet& images;
  std::span<const Camera> cameras;
  double noise_sigma = 0;  ///< standard deviation, square roots of linear light
  /// Of each camera, in world units: what hides from it what is looked at, and is not looked at
  /// itself. Empty: nothing does.
  std::span<const DepthMap> beside{};
};

/// The cameras in voxel coordinates of a grid.
std::vector<GridCamera> to_grid(std::span<const Camera> cameras, const GridSpec& grid);

/// The same as kernels take them, with the images' sharpness.
std::vector<shaders::GpuView> to_gpu_views(std::span<const GridCamera> cameras,
                                           const ImageSet& images);

}  // namespace photohull::projtex
