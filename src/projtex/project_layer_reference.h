// Double-precision reference of shaders/projtex_project_layer.comp.glsl.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/image.h"
#include "projtex/gpu_views.h"

namespace photohull::projtex::reference {

/// Linear-light RGBA, row-major from the top-left.
struct LinearImage {
  int width = 0;
  int height = 0;
  std::vector<glm::dvec4> pixels;
};

/// How a sample treats the levels around lambda; gpu::TextureArray::set_filter.
enum class MipFilter { kNearest, kTrilinear };

/// The image in a layer of `array_size` pixels (powers of two), its border repeated in the unused
/// part, and all smaller levels: means of 2 x 2 pixels in linear light, nothing rounded.
std::vector<LinearImage> mip_chain(const ColourImage& image, const glm::ivec2& array_size);

/// A voxel's square on a reference plane, in voxel coordinates.
struct PlaneSquare {
  glm::dvec3 centre{0.0};
  glm::dvec3 u{0.0}, v{0.0};  ///< edges
};

/// lambda: log2 of the pixels that a sample's footprint spans along its longest edge, with n x n
/// samples a square; 0 where pixels are larger than that, and behind the camera. The kernel uses
/// that of the square in the middle of a brick's apron for all of it.
double mip_level(const GridCamera& camera, const PlaneSquare& square, int supersample);

/// Square root of the linear colour that the photograph shows on the square, by n x n samples of
/// its mip chain at `lambda`, and their alpha; alpha -1 where the square's centre is not on the
/// image.
glm::dvec4 project_layer_sample(const GridCamera& camera, std::span<const LinearImage> mips,
                                const PlaneSquare& square, int supersample, double lambda,
                                MipFilter filter);

}  // namespace photohull::projtex::reference
