// Points of a surface as kernels take them, and the contract of the kernel that draws them into the
// cameras' depth maps. Lengths are in voxels.
#ifndef PHOTOHULL_SHADERS_SURFACE_POINTS_H
#define PHOTOHULL_SHADERS_SURFACE_POINTS_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace photohull::shaders {
using glm::ivec4;
using glm::vec4;
#elif !defined(constexpr)
#define constexpr const
#endif

constexpr int kSplatParametersBinding = 0;
constexpr int kSplatPointsBinding = 1;  // SurfacePoint

constexpr int kListedPoints = 64;     // points of a work group, with one list of views that may see them
constexpr float kSplatReach = 6.0f;   // texels: half the width of a near voxel in a depth map, at most

struct SplatParameters {
  ivec4 counts;  // x: points
};

// A point of a surface, for every kernel that takes a mesh's vertices.
struct SurfacePoint {
  vec4 position;  // xyz: voxel coordinates
  vec4 normal;    // xyz: unit and outward, or zero where unknown
};

#ifdef __cplusplus
static_assert(sizeof(SplatParameters) == 16);
static_assert(sizeof(SurfacePoint) == 32);
}  // namespace photohull::shaders
#endif

#endif  // PHOTOHULL_SHADERS_SURFACE_POINTS_H
