// Contract of the visual-hull kernels.
#ifndef PHOTOHULL_SHADERS_HULL_H
#define PHOTOHULL_SHADERS_HULL_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace photohull::shaders {
using glm::ivec4;
using glm::uint;
using glm::vec4;
#elif !defined(constexpr)
#define constexpr const
#endif

constexpr int kHullParametersBinding = 0;
constexpr int kHullNodesBinding = 1;      // of the classification
constexpr int kHullClassesBinding = 2;
constexpr int kHullRelevantBinding = 3;   // bits of the views that matter to each node
constexpr int kMaskPyramidUnit = 0;
constexpr int kNodeSilhouettesUnit = 1;
constexpr int kHullBricksBinding = 1;     // of the distances
constexpr int kHullDistancesBinding = 2;
constexpr int kHullViewListsBinding = 3;  // of the views that matter to each brick
constexpr int kBrickSilhouettesUnit = 0;

constexpr uint kNodeOutside = 0u;
constexpr uint kNodeInside = 1u;
constexpr uint kNodeSurface = 2u;
constexpr uint kNodeKindMask = 3u;
constexpr uint kNodeUnsure = 4u;  // flag: fewer views show all of the node than must see a point

constexpr int kMostMissing = 16;  // silhouettes that may leave a point out, at most

struct HullParameters {
  vec4 box_min;   // region of interest in voxel coordinates (w unused)
  vec4 box_max;
  ivec4 counts;   // x: items, y: views, z: words of a view bit set, w: views that must see a point
  vec4 pyramid;   // x: pixels of a cell at level 0, y: levels, z: margin in voxels, w: band in voxels
  ivec4 limits;   // x: silhouettes that may leave a point out, at most kMostMissing
  vec4 evidence;  // x: pixels outside an outline at which one view's evidence is full; 0: at once
};

#ifdef __cplusplus
static_assert(sizeof(HullParameters) == 96);
}  // namespace photohull::shaders
#endif

#endif  // PHOTOHULL_SHADERS_HULL_H
