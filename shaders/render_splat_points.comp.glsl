#version 450 core
#extension GL_GOOGLE_include_directive : require
// Depth maps of a mesh given as points closer together than the maps' texels: each point that faces
// a camera lowers the depth of the texel it falls into. What faces away is hidden by what faces the
// camera, or stands at the edge of an open mesh. One work group takes kSplatRun points a thread
// into one map, so that the camera is read once. Reference: render::reference::splat_point.
#include "include/projection.glsl"
#include "include/depth_map.glsl"
#include "shared/bake.h"

layout(local_size_x = 64) in;
layout(std140, binding = 0) uniform Parameters { BakeParameters parameters; };
layout(std430, binding = 1) readonly buffer Points { BakeVertex points[]; };

void main() {
  GpuView view = views[gl_WorkGroupID.y];
  DepthMapInfo info = depth_map_infos[gl_WorkGroupID.y];
  uint first = gl_WorkGroupID.x * 64u * uint(kSplatRun) + gl_LocalInvocationID.x;
  uint last = uint(parameters.counts.x) - 1u;
  for (int run = 0; run < kSplatRun; ++run) {
    uint i = min(first + uint(run) * 64u, last);  // drawing the last one twice does no harm
    vec3 position = points[i].position.xyz;
    vec3 p = project(view, position);
    vec2 pixel = p.xy / p.z;
    bool drawn = dot(view.centre.xyz - position, points[i].normal.xyz) >= 0.0 && p.z > 1.0 &&
                 on_image(view, pixel);
    ivec2 texel = min(ivec2((pixel + 0.5) * info.scale.x), info.size.xy - 1);
    uint at = uint(info.size.z + texel.y * info.size.x + texel.x);
    if (drawn) atomicMin(depth_maps[at], floatBitsToUint(p.z));
  }
}
