#version 450 core
#extension GL_GOOGLE_include_directive : require
// Plane sweep, step 3: photo-consistency of the selected voxels. The statistic is the mean pairwise
// zero-mean normalised cross-correlation of the patches around the voxel on the reference plane, over
// the views that see the voxel; a noise floor keeps flat patches from correlating, and views far below
// the best are left out once [Kutulakos00; Hernandez04]. One work group a selected brick.
// Reference: carving::reference::photo_consistency.
#include "include/projection.glsl"
#include "include/layer.glsl"
#include "include/depth_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 5) readonly buffer Selected { uint selected_count; uint pad0, pad1, pad2; uvec4 selected[]; };
layout(std430, binding = 6) readonly buffer Samples { vec4 samples[]; };
// Per selected brick and column: x: score in [-1, 1]; y: views used; z: texture variance; w: views that see it
layout(std430, binding = 7) writeonly buffer Scores { vec4 scores[]; };

const int kTaps = (2 * kPatchRadius + 1) * (2 * kPatchRadius + 1);
const float kOutlierShare = 0.5;  // views whose agreement is below this share of the best are dropped

uint patch_base(uint entry, uint slot) {
  uvec2 at = gl_LocalInvocationID.xy;
  return (entry * uint(kMaxLayerViews) + slot) * uint(kApronArea) + at.y * uint(kApronEdge) + at.x;
}

uint tap_offset(int tap) {
  int edge = 2 * kPatchRadius + 1;
  return uint((tap / edge) * kApronEdge + tap % edge);
}

void main() {
  uint entry = gl_WorkGroupID.x;
  uint id = gl_LocalInvocationIndex;
  uint global_entry = entry + uint(parameters.chunk.x);
  uvec4 work = selected[global_entry];
  if ((work[1u + (id >> 5u)] & (1u << (id & 31u))) == 0u) return;
  uint item = work.x;
  ivec2 uv = item_origin(item) + ivec2(gl_LocalInvocationID.xy);
  vec3 voxel = layer_point(vec2(uv), float(parameters.layer.x));
  int view_count = items[item].brick.w;

  uint slots[kMaxLayerViews];
  vec4 means[kMaxLayerViews];  // rgb: mean colour; w: 1 / standard deviation with the noise floor
  float self[kMaxLayerViews];  // correlation of the patch with itself: below 1 by the noise floor
  int n = 0;
  float texture_variance = 0.0;
  for (uint slot = 0u; slot < uint(view_count); ++slot) {
    uint v = items[item].views[slot >> 2u][slot & 3u];
    vec3 p = project(views[v], voxel);
    if (!visible(v, p.xy / p.z, p.z, parameters.thresholds.w)) continue;
    uint base = patch_base(entry, slot);
    vec3 sum = vec3(0.0), squares = vec3(0.0);
    bool whole = true;
    for (int tap = 0; tap < kTaps; ++tap) {
      vec4 s = samples[base + tap_offset(tap)];
      whole = whole && s.a >= 0.0;
      sum += s.rgb;
      squares += s.rgb * s.rgb;
    }
    if (!whole) continue;
    vec3 mean = sum / float(kTaps);
    vec3 variances = max(squares / float(kTaps) - mean * mean, 0.0);
    float variance = variances.r + variances.g + variances.b;
    float floored = variance + 3.0 * parameters.noise.x;
    slots[n] = base;
    means[n] = vec4(mean, inversesqrt(floored * float(kTaps)));
    self[n] = variance / floored;
    texture_variance += variance / 3.0;
    ++n;
  }
  vec4 result = vec4(-1.0, float(n), texture_variance / float(max(n, 1)), float(n));
  if (n >= 2) {
    float agreement[kMaxLayerViews];
    for (int i = 0; i < n; ++i) agreement[i] = -self[i];
    float total = 0.0;
    for (int tap = 0; tap < kTaps; ++tap) {
      uint offset = tap_offset(tap);
      vec3 sum = vec3(0.0);
      for (int i = 0; i < n; ++i)
        sum += (samples[slots[i] + offset].rgb - means[i].rgb) * means[i].w;
      for (int i = 0; i < n; ++i)
        agreement[i] += dot((samples[slots[i] + offset].rgb - means[i].rgb) * means[i].w, sum);
    }
    float best = -1.0;
    for (int i = 0; i < n; ++i) best = max(best, agreement[i]);
    int used = 0;
    float self_sum = 0.0;
    for (int i = 0; i < n; ++i) {
      bool keep = agreement[i] >= kOutlierShare * best;
      means[i].w *= keep ? 1.0 : 0.0;
      self_sum += keep ? self[i] : 0.0;
      used += keep ? 1 : 0;
    }
    if (used >= 2) {
      float squared = 0.0;
      for (int tap = 0; tap < kTaps; ++tap) {
        uint offset = tap_offset(tap);
        vec3 sum = vec3(0.0);
        for (int i = 0; i < n; ++i)
          sum += (samples[slots[i] + offset].rgb - means[i].rgb) * means[i].w;
        squared += dot(sum, sum);
      }
      result.x = (squared - self_sum) / float(used * (used - 1));
      result.y = float(used);
    }
  }
  scores[global_entry * 64u + id] = result;
}
