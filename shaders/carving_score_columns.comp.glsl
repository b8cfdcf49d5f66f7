#version 450 core
#extension GL_GOOGLE_include_directive : require
// Plane sweep, step 3: photo-consistency of the selected voxels. The statistic is the mean pairwise
// zero-mean normalised cross-correlation of the patches around the voxel on the reference plane, over
// the views that see the voxel; a noise floor keeps flat patches from correlating, and views far below
// the best are left out once [KutulakosSeitz00; Hernandez04]. One thread a selected column.
// Reference: carving::reference::photo_consistency.
#include "include/projection.glsl"
#include "include/layer.glsl"
#include "include/depth_map.glsl"
#include "include/selection.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 6) readonly buffer Samples { vec4 samples[]; };
// Per selected column: x: score in [-1, 1]; y: views used; z: texture variance; w: views that see it
layout(std430, binding = 7) writeonly buffer Scores { vec4 scores[]; };

const int kViews = kMaxLayerViews;
const int kPairs = kViews * (kViews - 1) / 2;
const int kPatchEdge = 2 * kPatchRadius + 1;
const float kTaps = float(kPatchEdge * kPatchEdge);
const float kOutlierShare = 0.5;  // views whose agreement is below this share of the best are dropped,
const float kOutlierSlack = 0.1;  // but none that is this close to it

void main() {
  uint index = gl_GlobalInvocationID.x + uint(parameters.chunk.z);
  if (gl_GlobalInvocationID.x >= uint(parameters.chunk.w)) return;
  Selection selection = selection_of(index);
  vec3 voxel = layer_point(vec2(selection.uv), float(parameters.layer.x));
  int view_count = items[selection.item].brick.w;

  bool seen[kViews];
  for (int i = 0; i < kViews; ++i) {
    uint v = items[selection.item].views[i >> 2][i & 3];
    vec3 p = project(views[v], voxel);
    seen[i] = i < view_count && visible(v, p.xy / p.z, p.z, parameters.thresholds.w);
  }

  // Sums over the patch: of each view's colours, of their squares and of the views' products.
  vec3 sums[kViews];
  float squares[kViews];
  float products[kPairs];
  for (int i = 0; i < kViews; ++i) {
    sums[i] = vec3(0.0);
    squares[i] = 0.0;
  }
  for (int i = 0; i < kPairs; ++i) products[i] = 0.0;
  uint base = (selection.entry - uint(parameters.chunk.x)) * uint(kViews * kApronArea) +
              (selection.column >> 3u) * uint(kApronEdge) + (selection.column & 7u);
  for (int row = 0; row < kPatchEdge; ++row)
    for (int at = 0; at < kPatchEdge; ++at) {
      uint tap = base + uint(row * kApronEdge + at);
      vec3 x[kViews];
      for (int i = 0; i < kViews; ++i) {
        vec4 s = samples[tap + uint(i * kApronArea)];
        seen[i] = seen[i] && s.a >= 0.0;
        // Centred on mid-grey: the products then lose no precision.
        x[i] = s.rgb - 0.5;
        sums[i] += x[i];
        squares[i] += dot(x[i], x[i]);
      }
      for (int i = 1; i < kViews; ++i)
        for (int j = 0; j < i; ++j) products[i * (i - 1) / 2 + j] += dot(x[i], x[j]);
    }

  float scale[kViews];  // 1 / standard deviation with the noise floor; 0 for views that do not count
  float texture_variance = 0.0;
  int n = 0;
  for (int i = 0; i < kViews; ++i) {
    float variance = max(squares[i] - dot(sums[i], sums[i]) / kTaps, 0.0) / kTaps;
    scale[i] = seen[i] ? inversesqrt(variance + 3.0 * parameters.noise.x) : 0.0;
    texture_variance += seen[i] ? variance / 3.0 : 0.0;
    n += seen[i] ? 1 : 0;
  }
  float agreement[kViews];
  for (int i = 0; i < kViews; ++i) agreement[i] = 0.0;
  for (int i = 1; i < kViews; ++i)
    for (int j = 0; j < i; ++j) {
      int pair = i * (i - 1) / 2 + j;
      float covariance = (products[pair] - dot(sums[i], sums[j]) / kTaps) / kTaps;
      products[pair] = covariance * scale[i] * scale[j];
      agreement[i] += products[pair];
      agreement[j] += products[pair];
    }
  float best = -1e30;
  for (int i = 0; i < kViews; ++i) best = seen[i] ? max(best, agreement[i]) : best;
  float least = best - max((1.0 - kOutlierShare) * best, kOutlierSlack);
  int used = 0;
  for (int i = 0; i < kViews; ++i) {
    seen[i] = seen[i] && agreement[i] >= least;
    used += seen[i] ? 1 : 0;
  }
  float score = 0.0;
  for (int i = 1; i < kViews; ++i)
    for (int j = 0; j < i; ++j) score += seen[i] && seen[j] ? products[i * (i - 1) / 2 + j] : 0.0;
  score = used >= 2 ? score / float(used * (used - 1) / 2) : -1.0;
  scores[index] = vec4(score, float(used), texture_variance / float(max(n, 1)), float(n));
}
