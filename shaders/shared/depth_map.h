// Contract of the kernels that draw depth maps of the cameras and look things up in them.
#ifndef PHOTOHULL_SHADERS_DEPTH_MAP_H
#define PHOTOHULL_SHADERS_DEPTH_MAP_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace photohull::shaders {
using glm::ivec4;
using glm::vec4;
#elif !defined(constexpr)
#define constexpr const
#endif

// Voxels to draw, ivec4 after a header of four words, the first of which is their number. The sweep
// writes such lists, so that these numbers fit beside those of shared/sweep.h.
constexpr int kOccludersBinding = 6;
constexpr int kDepthMapInfosBinding = 4;  // DepthMapInfo, one a camera
constexpr int kDepthMapsBinding = 5;      // depths of all maps, in one buffer
constexpr int kDepthMapLayersUnit = 2;    // or in the layers of an image

constexpr int kSplatGroup = 64;  // threads of a work group that draws
constexpr int kSplatRun = 16;    // points or voxels that a thread draws into a depth map

struct DepthMapInfo {
  ivec4 size;   // x, y: texels; z: first texel in the buffer, or layer of the image; w: view
  vec4 scale;   // x: texels per pixel
};

#ifdef __cplusplus
static_assert(sizeof(DepthMapInfo) == 32);
}  // namespace photohull::shaders
#endif

#endif  // PHOTOHULL_SHADERS_DEPTH_MAP_H
