// Cameras in the GPU's frame: voxel coordinates of a grid.
#pragma once

#include <span>
#include <vector>

#include "core/camera.h"
#include "core/grid.h"
#include "core/prepared_view.h"
#include "shared/view.h"

namespace photohull::projtex {

/// Camera as seen from the grid's voxel coordinates (double precision; the CPU references use it).
struct GridCamera {
  glm::dmat4x3 projection{1.0};  ///< (s, t, q) = projection * (voxel, 1); q in voxels, pixel = s/q
  glm::dvec3 centre{0.0};        ///< voxel coordinates
  double focal = 0;              ///< pixels
  int width = 0, height = 0;     ///< pixels
};

GridCamera to_grid(const Camera& camera, const GridSpec& grid);

/// Of the grid's frame, in voxels (core/viewing_depth.h).
double viewing_depth(const GridCamera& camera, const GridSpec& grid);

/// The same in single precision for images that sit at the origin of layers of an array texture of
/// `array_size` pixels. `sharpness` as ImageSet has it, in (0, 1].
shaders::GpuView to_gpu_view(const GridCamera& camera, const glm::ivec2& array_size,
                             double sharpness = 1);

/// Smallest array texture that holds images of all the sizes, as wide and high as a multiple of
/// `cut_at` pixels: where images were cut at multiples of it, texels of mip levels begin there,
/// too.
glm::ivec2 array_size(std::span<const Camera> cameras, int cut_at = 1);

std::vector<Camera> cameras_of(std::span<const PreparedView> views);

}  // namespace photohull::projtex
