// Contract of the kernels that match surface patches between views. Lengths are in voxels.
#ifndef PHOTOHULL_SHADERS_REFINE_H
#define PHOTOHULL_SHADERS_REFINE_H

#include "shared/surface_points.h"
#include "shared/view.h"

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace photohull::shaders {
using glm::ivec4;
using glm::vec4;
#elif !defined(constexpr)
#define constexpr const
#endif

constexpr int kChooseParametersBinding = 0;
constexpr int kChooseSurfelsBinding = 1;    // SurfacePoint
constexpr int kChooseChoicesBinding = 2;    // MatchChoice
constexpr int kChooseViewListsBinding = 3;  // of render::list_views
constexpr int kMatchParametersBinding = 0;
constexpr int kMatchSurfelsBinding = 1;     // MatchSurfel
constexpr int kMatchChoicesBinding = 2;     // MatchChoice
constexpr int kMatchScoresBinding = 3;
constexpr int kMatchBendsBinding = 4;       // curvature along uu, uv, vv of tangent_patch
constexpr int kMatchTexturesBinding = 5;
constexpr int kMatchSharedViewsBinding = 1;  // SharedViews
constexpr int kFitParametersBinding = 0;
constexpr int kFitSurfelsBinding = 1;       // SurfacePoint
constexpr int kFitChoicesBinding = 2;       // MatchChoice
constexpr int kFitResultsBinding = 3;
constexpr int kFitShapesBinding = 4;

constexpr int kPatchGroup = 64;       // threads of a work group that match or fit

constexpr int kMatchViews = 6;        // the reference view and those compared with it
constexpr int kMatchCandidates = 16;  // views, the worthiest ones, that the choice is made among
constexpr int kMatchRadius = 2;  // taps: every other place of 5 x 5 in the tangent plane
constexpr int kMatchTaps = 13;
constexpr int kHiddenViews = 4;  // views that face a surfel and whose sight something blocks
constexpr float kNoScore = -2.0f;  // too few views to compare

struct ChooseParameters {
  ivec4 counts;      // x: surfels, y: views
  vec4 visibility;   // x: shift of the receiver along the normal, y: bias of the depth test,
                     // z: least cosine between a normal and a camera it is matched in, w: one that sees it
  vec4 angles;       // x, y: cosines of the least and the largest angle to the reference,
                     // z: cosine of the angle below which two views are near-duplicates
};

struct MatchParameters {
  ivec4 counts;      // x: surfels, z: offsets
  vec4 search;       // x: first offset along the normal, y: step between offsets; patch spacing is
                     // at least z voxels and w pixels of the reference
  vec4 consistency;  // x: variance of image noise (square-root encoding), y: share of pairs that count,
                     // z: variance that raises that of patches in their correlation
};

struct MatchSurfel {
  vec4 position;  // xyz: voxel coordinates; w: what its offsets are multiplied with
  vec4 normal;    // xyz: unit and outward; w: the number of its MatchChoice
};

// The views that a surfel is matched in, by number; -1 in the places behind the last one. Such arrays lie
// in storage buffers (std430) as they do in C++, in a uniform block (std140) they would not.
struct MatchChoice {
  int views[kMatchViews];    // the reference view, then those compared with it
  int seen;                  // views that see the surfel
  int count;                 // views that it is matched in
  int hidden[kHiddenViews];  // the most frontal views that something hides it from
};

// The views of a choice that all surfels have.
struct SharedViews {
  GpuView views[kMatchViews];
  ivec4 layers[kMatchViews];  // x: their numbers
};

// Fitting planes to the images after matching.
struct FitParameters {
  ivec4 counts;  // x: surfels, z: Gauss-Newton steps
  vec4 search;   // x, y: the patch's spacing as in MatchParameters::search.zw, z: largest offset in
                 // all, w: in one step
  vec4 robust;   // x: variance of image noise, y, z: correlations of weight 0 and 1,
                 // w: standard deviation of the surfels' slopes
};

struct FitShape {
  vec4 curvature;  // x, y, z: second derivatives of the height over the tangent plane along uu, uv, vv
                   // of tangent_patch; w: 1 where a view is held out
};

struct FitResult {
  vec4 plane;     // xyz: unit normal, w: offset along the surfel's own normal
  vec4 evidence;  // x: information on the offset, 1 / voxel^2, y: score,
                  // z, w: the held-out view's score before and after, kNoScore without
};

#ifdef __cplusplus
static_assert(sizeof(FitParameters) == 48);
static_assert(sizeof(FitShape) == 16);
static_assert(sizeof(FitResult) == 32);
static_assert(sizeof(ChooseParameters) == 48);
static_assert(sizeof(MatchParameters) == 48);
static_assert(sizeof(MatchSurfel) == 32);
static_assert(sizeof(MatchChoice) == 4 * (kMatchViews + 2 + kHiddenViews));
}  // namespace photohull::shaders
#endif

#endif  // PHOTOHULL_SHADERS_REFINE_H
