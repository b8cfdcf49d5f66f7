#version 450 core
#extension GL_GOOGLE_include_directive : require
// Truncated signed distance to the visual hull for every voxel of a brick: the greatest, over the
// views that see the voxel, of its distance to the silhouette, brought from pixels to voxels by
// depth / focal length. One work group a brick, one thread a run of 8 voxels along z.
// Reference: carving::reference::hull_distance.
#include "include/projection.glsl"
#include "shared/hull.h"

layout(local_size_x = 64) in;
layout(std140, binding = 0) uniform Parameters { HullParameters parameters; };
layout(std430, binding = 1) readonly buffer Bricks { ivec4 bricks[]; };
layout(std430, binding = 2) writeonly buffer Distances { float distances[]; };
layout(std430, binding = 3) readonly buffer Relevant { uint relevant[]; };
layout(binding = 0) uniform sampler2DArray silhouettes;  // signed pixels, positive outside

void main() {
  uint brick = gl_WorkGroupID.x;
  uint run = gl_LocalInvocationID.x;
  vec3 base = vec3(bricks[brick].xyz * 8 + ivec3(run >> 3u, run & 7u, 0));
  float band = parameters.pyramid.w;
  float value[8];
  int seen[8];
  for (int i = 0; i < 8; ++i) {
    vec3 p = base + vec3(0.0, 0.0, float(i));
    vec3 beyond = max(parameters.box_min.xyz - p, p - parameters.box_max.xyz);
    value[i] = clamp(max(beyond.x, max(beyond.y, beyond.z)), -band, band);
    seen[i] = 0;
  }
  int words = parameters.counts.z;
  bool count_views = parameters.counts.w > 1;
  for (int v = 0; v < parameters.counts.y; ++v) {
    bool silhouette_matters =
        (relevant[brick * uint(words) + uint(v >> 5)] & (1u << uint(v & 31))) != 0u;
    if (!silhouette_matters && !count_views) continue;
    GpuView view = views[v];
    vec3 p = project(view, base);
    vec3 dz = vec3(view.row_s.z, view.row_t.z, view.row_q.z);
    for (int i = 0; i < 8; ++i, p += dz) {
      vec2 pixel = p.xy / p.z;
      if (p.z <= 0.0 || !on_image(view, pixel)) continue;
      ++seen[i];
      if (!silhouette_matters) continue;
      float d = textureLod(silhouettes, vec3(texture_coordinate(view, pixel), float(v)), 0.0).r;
      value[i] = max(value[i], d * p.z / view.centre.w);
    }
  }
  for (int i = 0; i < 8; ++i) {
    bool unseen = count_views && seen[i] < parameters.counts.w;
    distances[brick * 512u + run * 8u + uint(i)] = unseen ? band : min(value[i], band);
  }
}
