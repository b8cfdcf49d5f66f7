// A camera as the shaders see it; the same text is compiled as C++ and as GLSL.
// All lengths are in voxels of the grid, so that shaders never meet the scene's scale or offset.
#ifndef PHOTOHULL_SHADERS_VIEW_H
#define PHOTOHULL_SHADERS_VIEW_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace photohull::shaders {
using glm::vec4;
#elif !defined(constexpr)
#define constexpr const
#endif

constexpr int kViewsBinding = 0;  // GpuView, one a camera
constexpr int kImagesUnit = 0;    // array texture of the photographs

struct GpuView {
  vec4 row_s;   // homogeneous texture coordinates: (s, t, q) = rows . (voxel coordinate, 1);
  vec4 row_t;   //   pixel = (s / q, t / q), q = depth along the optical axis
  vec4 row_q;
  vec4 centre;  // xyz: optical centre; w: focal length in pixels (geometric mean of fx and fy)
  vec4 size;    // xy: image size in pixels; zw: reciprocal size of the array texture in pixels
  vec4 detail;  // x: fine detail beside other views of the same (ImageSet::sharpness), at most 1
};

// GpuViews as uniforms in place of those at kViewsBinding (UNIFORM_VIEWS), as many as every device has room for.
constexpr int kUniformViewsBinding = 2, kMostUniformViews = 170;

#ifdef __cplusplus
static_assert(sizeof(GpuView) == 96);
}  // namespace photohull::shaders
#endif

#endif  // PHOTOHULL_SHADERS_VIEW_H
