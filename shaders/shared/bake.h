// Contract of the kernel that bakes colour onto a mesh's vertices. Lengths are in voxels.
#ifndef PHOTOHULL_SHADERS_BAKE_H
#define PHOTOHULL_SHADERS_BAKE_H

#include "shared/surface_points.h"

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace photohull::shaders {
using glm::ivec4;
using glm::vec4;
#elif !defined(constexpr)
#define constexpr const
#endif

constexpr int kBakeParametersBinding = 0;
constexpr int kBakeVerticesBinding = 1;   // SurfacePoint
constexpr int kBakeResultsBinding = 2;
constexpr int kBakeViewListsBinding = 3;  // of render::list_views

constexpr int kMaxBakeViews = 6;            // views whose colours are mixed, the best ones
constexpr float kBakeMinCosine = 0.2f;      // views flatter than this to the surface say nothing
constexpr float kBakeShift = 1.5f;          // voxels along the normal, to where visibility is tested
constexpr float kBakeDepthBias = 2.5f;      // voxels
constexpr float kBakeTexel = 2.0f;          // voxels that a depth map's texel is wide
constexpr float kBakeMinAlpha = 0.5f;       // below: the image knows nothing there
constexpr int kBakeDetailLevels = 2;        // mip levels from a colour to its surroundings

struct BakeParameters {
  ivec4 counts;  // x: vertices, y: views
  vec4 noise;    // x: standard deviation of the image noise, square-root encoding
};

struct BakeResult {
  vec4 colour;    // rgb: linear, w: views whose colours are mixed; 0: nobody sees the vertex
  vec4 evidence;  // scatter, disagreement, fine disagreement, fine energy of render::SurfaceEvidence
  vec4 sight;     // x: views that see the vertex, also those whose colours are not mixed
};

#ifdef __cplusplus
static_assert(sizeof(BakeParameters) == 32);
static_assert(sizeof(BakeResult) == 48);
}  // namespace photohull::shaders
#endif

#endif  // PHOTOHULL_SHADERS_BAKE_H
