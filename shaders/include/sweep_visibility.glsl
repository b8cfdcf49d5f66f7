// How much of a voxel's part of a layer a view sees among what the sweep has passed, by the test that
// SWEEP_... chooses (visibility/sweep_test.h); a constant bias in voxels with all of them.
// Reference: visibility::reference::sweep_visible.

#if defined(SWEEP_RAYS)
layout(std430, binding = kSweepTableBinding) readonly buffer Table { uint table[]; };
layout(std430, binding = kSweepPassedBinding) readonly buffer Passed { uint passed[]; };  // one bit a voxel, as Occupancy

bool is_passed(ivec3 voxel) {
  ivec3 b = voxel >> 3, l = voxel & 7;
  uint slot = table[(b.z * parameters.bricks.y + b.y) * parameters.bricks.x + b.x];
  if (slot == 0xffffffffu) return false;
  uint offset = uint((l.x << 6) | (l.y << 3) | l.z);
  return (passed[slot * 16u + (offset >> 5u)] & (1u << (offset & 31u))) != 0u;
}

// From beyond the bias to the camera, voxel by voxel [AmanatidesWoo87].
float sweep_visible(uint v, vec3 voxel, vec3 p, float bias) {
  vec3 ray = views[v].centre.xyz - voxel, origin = voxel + 0.5;
  float t = bias / p.z;  // the ray's depth falls from p.z to 0
  ivec3 last = parameters.bricks.xyz * 8 - 1;
  ivec3 cell = ivec3(floor(origin + t * ray)), towards = ivec3(sign(ray));
  vec3 inverse = 1.0 / mix(ray, vec3(1e-30), equal(ray, vec3(0.0)));
  vec3 wall = vec3(cell) + vec3(greaterThan(ray, vec3(0.0)));
  vec3 next = mix((wall - origin) * inverse, vec3(1e30), equal(ray, vec3(0.0)));
  while (t < 1.0 && all(greaterThanEqual(cell, ivec3(0))) && all(lessThanEqual(cell, last))) {
    if (is_passed(cell)) return 0.0;
    int axis = next.x <= next.y ? (next.x <= next.z ? 0 : 2) : (next.y <= next.z ? 1 : 2);
    t = next[axis];
    next[axis] += abs(inverse[axis]);
    cell[axis] += towards[axis];
  }
  return 1.0;
}

#else
#include "include/depth_map.glsl"

const float kSteepestLayer = 4.0;  // voxels of depth a texel: a layer seen so flat is edge-on

// Change of 1 / depth along the map's texels on the layer; 0 where it is seen edge-on.
vec2 layer_slope(uint v, vec2 pixel, float depth, float scale) {
  vec3 u = vec3(0.0), w = vec3(0.0);
  u[parameters.axes.x] = 1.0;
  w[parameters.axes.y] = 1.0;
  vec3 a = project_step(views[v], u), b = project_step(views[v], w);
  a.xy -= pixel * a.z;
  b.xy -= pixel * b.z;
  float det = a.x * b.y - a.y * b.x;
  if (abs(det) < 1e-12) return vec2(0.0);
  return vec2(b.z * a.y - a.z * b.y, a.z * b.x - b.z * a.x) / (det * depth * scale);
}

float sweep_visible(uint v, vec3 voxel, vec3 p, float bias) {
  DepthMapInfo info = depth_map_infos[v];
  vec2 pixel = p.xy / p.z, at = (pixel + 0.5) * info.scale.x;
#if defined(SWEEP_VIRTUAL) || defined(SWEEP_RECEIVER_PLANE)
  vec2 slope = layer_slope(v, pixel, p.z, info.scale.x);
#endif
#if defined(SWEEP_PCF)
  const int radius = 1;
#else
  const int radius = 0;
#endif
#if defined(SWEEP_RECEIVER_PLANE)
  bias += min(0.5 * p.z * p.z * (abs(slope.x) + abs(slope.y)), kSteepestLayer);
#endif
  float passed_taps = 0.0, taps = 0.0;
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x) {
      ivec2 texel = clamp(ivec2(floor(at)) + ivec2(x, y), ivec2(0), info.size.xy - 1);
      float depth = p.z;
#if defined(SWEEP_VIRTUAL)
      vec2 away = vec2(texel) + 0.5 - at;
      float most = kSteepestLayer * (abs(away.x) + abs(away.y));
      float inverse = 1.0 / p.z + dot(slope, away);
      depth = clamp(inverse > 0.0 ? 1.0 / inverse : p.z + most, p.z - most, p.z + most);
#endif
      passed_taps += depth <= uintBitsToFloat(depth_bits(info, texel)) + bias ? 1.0 : 0.0;
      taps += 1.0;
    }
  return passed_taps / taps;
}
#endif
