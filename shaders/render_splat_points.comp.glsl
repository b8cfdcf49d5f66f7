#version 450 core
#extension GL_GOOGLE_include_directive : require
// Depth maps of a mesh given as points closer together than the maps' texels: each point that faces
// a camera lowers the depth of the texel it falls into, and of those that its voxel covers where it
// is so near that a voxel is wider. What faces away is hidden by what faces the
// camera, or stands at the edge of an open mesh. One work group takes kSplatRun points a thread
// into one map, so that the camera is read once. Reference: render::reference::splat_point.
#include "include/dispatch.glsl"
#include "include/projection.glsl"
#include "include/depth_map.glsl"
#include "shared/surface_points.h"

layout(local_size_x = 64) in;  // kSplatGroup
layout(std140, binding = kSplatParametersBinding) uniform Parameters { SplatParameters parameters; };
layout(std430, binding = kSplatPointsBinding) readonly buffer Points { SurfacePoint points[]; };

void main() {
  GpuView view = views[work_group().y];
  DepthMapInfo info = depth_map_infos[work_group().y];
  uint first = work_group().x * uint(kSplatGroup * kSplatRun) + gl_LocalInvocationID.x;
  uint last = uint(parameters.counts.x) - 1u;
  for (int run = 0; run < kSplatRun; ++run) {
    uint i = min(first + uint(run * kSplatGroup), last);  // drawing the last one twice does no harm
    vec3 position = points[i].position.xyz;
    vec3 p = project(view, position);
    vec2 pixel = p.xy / p.z;
    bool drawn = dot(view.centre.xyz - position, points[i].normal.xyz) >= 0.0 && p.z > 1.0 &&
                 on_image(view, pixel);
    ivec2 low = ivec2(0), high = ivec2(-1);  // texels: none
    if (drawn) {  // pixels of what is not drawn may be no numbers
      vec2 middle = (pixel + 0.5) * info.scale.x;
      low = high = min(ivec2(middle), info.size.xy - 1);
      // Nearer than half of what the map was made for, points are farther apart than texels.
      float half_width = min(0.5 * view.centre.w / p.z * info.scale.x, kSplatReach);
      if (half_width > 0.5) {
        low = max(ivec2(floor(middle - half_width)), ivec2(0));
        high = min(ivec2(floor(middle + half_width)), info.size.xy - 1);
      }
    }
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x)
        lower_depth(info, ivec2(x, y), floatBitsToUint(p.z));
  }
}
