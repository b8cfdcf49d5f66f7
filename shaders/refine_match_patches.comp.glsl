#version 450 core
#extension GL_GOOGLE_include_directive : require
// Photo-consistency of tangent patches at offsets along the normal: all chosen views are projected
// onto the patch by one affine footprint each, at the mip level of its area, and compared with the
// reference view by zero-mean normalised cross-correlation over all channels, with the rounding of
// 8-bit codes as a floor of both variances; the score is the mean of the best share of the pairs. The share of
// the reference's variance that is not noise, at the middle offset, is the surfel's texture. With
// PATCH_BENT patches follow the surface's curvature; with TEXTURES_ALONE nothing is compared. With
// SHARED_VIEWS, their number, all surfels are matched in the same views, which come as uniforms: software
// devices fetch those once for all threads of a vector, and what else there is for each. One thread an offset of a surfel, so that the
// threads of a vector share their views.
// Reference: refine::reference::match_patch.
#include "include/dispatch.glsl"
#include "include/projection.glsl"
#include "include/patch.glsl"
#include "shared/refine.h"

layout(local_size_x = 64) in;  // kPatchGroup
layout(std140, binding = kMatchParametersBinding) uniform Parameters { MatchParameters parameters; };
layout(std430, binding = kMatchSurfelsBinding) readonly buffer Surfels { MatchSurfel surfels[]; };
#ifdef SHARED_VIEWS
layout(std140, binding = kMatchSharedViewsBinding) uniform Shared { SharedViews shared_views; };
#else
layout(std430, binding = kMatchChoicesBinding) readonly buffer Choices { MatchChoice choices[]; };
#endif
layout(std430, binding = kMatchScoresBinding) writeonly buffer Scores { float scores[]; };
layout(std430, binding = kMatchTexturesBinding) writeonly buffer Textures { float textures[]; };  // of the surfels, [0, 1]
#ifdef PATCH_BENT
layout(std430, binding = kMatchBendsBinding) readonly buffer Bends { vec4 bends[]; };  // curvature along uu, uv, vv
#endif

const float kTapCount = float(kTaps);

// Colours of the taps of the reference view's patch.
vec3 reference_colours[kTaps];

// What correlations with the reference view's patch need beside its colours.
struct ReferenceMoments {
  vec3 sum;        // of the colours
  float variance;  // of all values, times their number
  float scale;     // 1 / root of that variance with the lift
};

// What is added to the variances of both patches in a correlation, so that rounding does not count.
float variance_lift() { return 3.0 * kTapCount * parameters.consistency.z; }

// Fetches reference_colours, and their moments.
ReferenceMoments fetch_reference(GpuView view, int layer, TangentPatch t) {
  PatchFootprint f = footprint(view, layer, t);
  ReferenceMoments r;
  r.sum = vec3(0.0);
  float squares = 0.0;
  for (int k = 0; k < kTaps; ++k) {
    vec3 x = tap(f, k, t.bend);
    reference_colours[k] = x;
    r.sum += x;
    squares += dot(x, x);
  }
  r.variance = max(squares - dot(r.sum, r.sum) / kTapCount, 0.0);
  r.scale = inversesqrt(r.variance + variance_lift());
  return r;
}

// Zero-mean normalised cross-correlation of a view's patch with the reference view's.
float correlation(GpuView view, int layer, TangentPatch t, ReferenceMoments r) {
  PatchFootprint f = footprint(view, layer, t);
  vec3 sum = vec3(0.0);
  float squares = 0.0, product = 0.0;
  for (int k = 0; k < kTaps; ++k) {
    vec3 x = tap(f, k, t.bend);
    sum += x;
    squares += dot(x, x);
    product += dot(x, reference_colours[k]);
  }
  return (product - dot(r.sum, sum) / kTapCount) * r.scale *
         inversesqrt(max(squares - dot(sum, sum) / kTapCount, 0.0) + variance_lift());
}

// Puts the score of a pair of views into its place in the falling order.
void insert(float score, inout float pairs[kMatchViews - 1]) {
  for (int k = 0; k < kMatchViews - 1; ++k) {
    float kept = max(pairs[k], score);
    score = min(pairs[k], score);
    pairs[k] = kept;
  }
}

// Mean over the best share of the pairs that `count` views make with their reference.
float mean_of_best(float pairs[kMatchViews - 1], int count) {
  int best = int(ceil(parameters.consistency.y * float(count - 1)));
  float total = 0.0;
  for (int k = 0; k < kMatchViews - 1; ++k) total += k < best ? pairs[k] : 0.0;
  return total / float(best);
}

// The patch of a surfel that was moved by an offset.
TangentPatch patch_of_surfel(uint i, float offset, GpuView reference) {
  vec3 normal = surfels[i].normal.xyz;
  TangentPatch t = tangent_patch(surfels[i].position.xyz + offset * normal, normal, reference,
                                 parameters.search.z, parameters.search.w);
#ifdef PATCH_BENT
  t.bend = vec3(0.5, 1.0, 0.5) * bends[i].xyz * dot(t.u, t.u);
#endif
  return t;
}

// Score of one surfel at one offset, and at the middle offset the surfel's texture.
void main() {
  uint offsets = uint(parameters.counts.z);
  uint i = invocation().x / offsets;
  if (i >= uint(parameters.counts.x)) return;
  float offset = (parameters.search.x + parameters.search.y * float(invocation().x % offsets)) *
                 surfels[i].position.w;
#ifdef SHARED_VIEWS
  GpuView own = shared_views.views[0];
  int layer = shared_views.layers[0].x;
#else
  MatchChoice choice = choices[int(surfels[i].normal.w)];
  if (choice.count < 2) {
#ifndef TEXTURES_ALONE
    scores[invocation().x] = kNoScore;
#endif
    textures[i] = 1.0;
    return;
  }
  int layer = choice.views[0];
  GpuView own = views[layer];
#endif
  TangentPatch t = patch_of_surfel(i, offset, own);
  ReferenceMoments reference = fetch_reference(own, layer, t);
  if (invocation().x % offsets == offsets / 2u)
    textures[i] = reference.variance / (reference.variance + 3.0 * kTapCount * parameters.consistency.x);

#ifndef TEXTURES_ALONE
  float pairs[kMatchViews - 1];
  for (int k = 0; k < kMatchViews - 1; ++k) pairs[k] = -1.0;
#ifdef SHARED_VIEWS
  const int count = SHARED_VIEWS;
  // By numbers that are constants, so that the views' addresses are.
#define COMPARE(v) insert(correlation(shared_views.views[v], shared_views.layers[v].x, t, reference), pairs)
  COMPARE(1);
#if SHARED_VIEWS > 2
  COMPARE(2);
#endif
#if SHARED_VIEWS > 3
  COMPARE(3);
#endif
#if SHARED_VIEWS > 4
  COMPARE(4);
#endif
#if SHARED_VIEWS > 5
  COMPARE(5);
#endif
#else
  int count = choice.count;
  for (int v = 1; v < count; ++v)
    insert(correlation(views[choice.views[v]], choice.views[v], t, reference), pairs);
#endif
  scores[invocation().x] = mean_of_best(pairs, count);
#endif
}
