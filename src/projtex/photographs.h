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

/// Photographs of parts of a scene are cut at multiples of so many pixels, which is the width of a
/// texel of the sixth mip level, so that the texels of all levels stay.
inline constexpr int kCutPixels = 32;

/// Images and cameras are in the same order and outlive the object.
struct Photographs {
  const ImageSet& images;
  std::span<const Camera> cameras;
  double noise_sigma = 0;  ///< standard deviation, square roots of linear light
  /// Of each camera, in world units: what hides from it what is looked at, and is not looked at
  /// itself. Empty: nothing does.
  std::span<const DepthMap> beside{};

  bool are_of_part() const { return !beside.empty(); }
  /// Pixels at whose multiples they may have been cut; 1: they were not.
  int cut_at() const { return are_of_part() ? kCutPixels : 1; }
};

/// The cameras in voxel coordinates of a grid.
std::vector<GridCamera> to_grid(std::span<const Camera> cameras, const GridSpec& grid);

/// The same as kernels take them, with the images' sharpness.
std::vector<shaders::GpuView> to_gpu_views(std::span<const GridCamera> cameras,
                                           const ImageSet& images);

}  // namespace photohull::projtex
