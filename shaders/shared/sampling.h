// Contract of the kernels that sample photographs on oriented planes. Lengths are in voxels.
#ifndef PHOTOHULL_SHADERS_SAMPLING_H
#define PHOTOHULL_SHADERS_SAMPLING_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace photohull::shaders {
using glm::vec4;
#elif !defined(constexpr)
#define constexpr const
#endif

constexpr int kSquaresBinding = 1;        // PlaneSquare
constexpr int kSquareSamplesBinding = 2;
constexpr int kFetchSumsBinding = 0;      // of the bare loop of fetches
constexpr int kImageSumsUnit = 1;         // what a sampler reads beside the photographs: sums over
constexpr int kImageRipmapsUnit = 1;      // rectangles, or levels of their own along x and y

constexpr int kSquareGroup = 64;        // squares of a work group
constexpr float kLeastCoverage = 0.125f;  // share of a footprint that must be on the object's image

struct PlaneSquare {
  vec4 centre;  // xyz: voxel coordinates; w: view
  vec4 u;       // xyz: edges
  vec4 v;
};

#ifdef __cplusplus
static_assert(sizeof(PlaneSquare) == 48);
}  // namespace photohull::shaders
#endif

#endif  // PHOTOHULL_SHADERS_SAMPLING_H
