#version 450 core
#extension GL_GOOGLE_include_directive : require
// Photo-consistency of tangent patches at offsets along the normal: all chosen views are projected
// onto the patch by one affine footprint each, at the mip level of its area, and compared with the
// reference view by zero-mean normalised cross-correlation over all channels, with the rounding of
// 8-bit codes as a floor of both variances; the score is the mean of the best share of the pairs. The share of
// the reference's variance that is not noise, at the middle offset, is the surfel's texture. With
// PATCH_BENT patches follow the surface's curvature. One thread an offset of a surfel, so that the
// threads of a vector share their views.
// Reference: refine::reference::match_patch.
#include "include/dispatch.glsl"
#include "include/projection.glsl"
#include "include/patch.glsl"
#include "shared/refine.h"

layout(local_size_x = 64) in;  // kPatchGroup
layout(std140, binding = kMatchParametersBinding) uniform Parameters { MatchParameters parameters; };
layout(std430, binding = kMatchSurfelsBinding) readonly buffer Surfels { MatchSurfel surfels[]; };
layout(std430, binding = kMatchChoicesBinding) readonly buffer Choices { MatchChoice choices[]; };
layout(std430, binding = kMatchScoresBinding) writeonly buffer Scores { float scores[]; };
layout(std430, binding = kMatchTexturesBinding) writeonly buffer Textures { float textures[]; };  // of the surfels, [0, 1]
#ifdef PATCH_BENT
layout(std430, binding = kMatchBendsBinding) readonly buffer Bends { vec4 bends[]; };  // curvature along uu, uv, vv
#endif

void main() {
  uint offsets = uint(parameters.counts.z);
  uint i = invocation().x / offsets;
  if (i >= uint(parameters.counts.x)) return;
  float offset = (parameters.search.x + parameters.search.y * float(invocation().x % offsets)) *
                 surfels[i].position.w;
  vec3 normal = surfels[i].normal.xyz;
  vec3 centre = surfels[i].position.xyz + offset * normal;
  int count = choices[i].second.w;
  if (count < 2) {
    scores[invocation().x] = kNoScore;
    textures[i] = 1.0;
    return;
  }
  int chosen[kMatchViews] = int[kMatchViews](choices[i].first.x, choices[i].first.y, choices[i].first.z,
                                             choices[i].first.w, choices[i].second.x, choices[i].second.y);
  vec3 u, w;
  patch_axes(centre, normal, views[chosen[0]], parameters.search.z, parameters.search.w, u, w);

#ifdef PATCH_BENT
  vec3 bend = vec3(0.5, 1.0, 0.5) * bends[i].xyz * dot(u, u);
#else
  vec3 bend = vec3(0.0);
#endif

  vec3 patch_of_reference[kTaps];
  vec3 sum = vec3(0.0);
  float squares = 0.0;
  PatchFootprint f = footprint(chosen[0], centre, u, w, normal);
  for (int k = 0; k < kTaps; ++k) {
    vec3 x = tap(f, k, bend);
    patch_of_reference[k] = x;
    sum += x;
    squares += dot(x, x);
  }
  const float n = float(kTaps);
  float lift = 3.0 * n * parameters.consistency.z;
  float variance = max(squares - dot(sum, sum) / n, 0.0);
  float scale = inversesqrt(variance + lift);
  if (invocation().x % offsets == offsets / 2u) textures[i] = variance / (variance + 3.0 * n * parameters.consistency.x);

  float pairs[kMatchViews - 1];
  for (int k = 0; k < kMatchViews - 1; ++k) pairs[k] = -1.0;
  for (int v = 1; v < count; ++v) {
    f = footprint(chosen[v], centre, u, w, normal);
    vec3 other_sum = vec3(0.0);
    float other_squares = 0.0, product = 0.0;
    for (int k = 0; k < kTaps; ++k) {
      vec3 x = tap(f, k, bend);
      other_sum += x;
      other_squares += dot(x, x);
      product += dot(x, patch_of_reference[k]);
    }
    float score = (product - dot(sum, other_sum) / n) * scale *
                  inversesqrt(max(other_squares - dot(other_sum, other_sum) / n, 0.0) + lift);
    for (int k = 0; k < kMatchViews - 1; ++k) {
      float kept = max(pairs[k], score);
      score = min(pairs[k], score);
      pairs[k] = kept;
    }
  }
  int best = int(ceil(parameters.consistency.y * float(count - 1)));
  float total = 0.0;
  for (int k = 0; k < kMatchViews - 1; ++k) total += k < best ? pairs[k] : 0.0;
  scores[invocation().x] = total / float(best);
}
