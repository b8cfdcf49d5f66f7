#version 450 core
#extension GL_GOOGLE_include_directive : require
// Plane sweep, step 3: photo-consistency of the selected voxels, by a statistic over the patches around
// the voxel on the reference plane, of the views that see the voxel [KutulakosSeitz00]. One thread a
// selected column. References: those of the statistics.
#include "include/dispatch.glsl"
#include "include/projection.glsl"
#include "include/layer_items.glsl"
#include "include/sweep_visibility.glsl"
#include "include/selection.glsl"
#include "include/patch_views.glsl"
#if SEARCH_TAPS > 1
#include "include/search_patches.glsl"
#endif

// The correlation, or the statistic that the host names instead (carving/statistic.h).
#include "include/consistency_zncc.glsl"

layout(local_size_x = 64) in;
// Per selected column: x: score in [-1, 1]; y: views used; z: confidence; w: views that see it, by their shares
layout(std430, binding = kSweepScoresBinding) writeonly buffer Scores { vec4 scores[]; };

void main() {
  uint index = invocation().x + uint(parameters.chunk.z);
  if (invocation().x >= uint(parameters.chunk.w)) return;
  SelectedColumn selected = selected_columns[index];
  vec3 voxel = layer_point(vec2(selected.u, selected.v), float(parameters.layer.x));
  int view_count = items[selected.item].brick.w;

  uint seen = 0u;  // views, as bits
  float sum = 0.0;  // of the views' shares
  for (int i = 0; i < kViews; ++i) {
    uint v = items[selected.item].views[i >> 2][i & 3];
    vec3 p = project(views[v], voxel);
    view_weights[i] = i < view_count ? sweep_visible(v, voxel, p, parameters.thresholds.w) : 0.0;
    seen |= view_weights[i] > 0.0 ? 1u << uint(i) : 0u;
  }
  uint base = (selected.brick - uint(parameters.chunk.x)) * uint(kViews * SEARCH_TAPS * kApronArea) +
              uint(selected.v & 7) * uint(kApronEdge) + uint(selected.u & 7);
#if SEARCH_TAPS > 1
  choose_shifts(base, seen);
#endif
  Consistency c = consistency(base, seen);
  for (int i = 0; i < kViews; ++i) sum += has(seen, i) ? view_weights[i] : 0.0;
  scores[index] = vec4(c.score, float(c.used), c.confidence, sum);
}
