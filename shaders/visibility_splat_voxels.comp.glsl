#version 450 core
#extension GL_GOOGLE_include_directive : require
// Depth maps of voxels: each voxel of a list lowers the depth of every texel that its bounding square
// touches, in all maps. One work group takes kSplatRun voxels a thread into one map, so that the
// camera is read once. y: map. Reference: visibility::reference::splat_voxel.
#include "include/dispatch.glsl"
#include "include/projection.glsl"
#include "include/depth_map.glsl"

layout(local_size_x = 64) in;  // kSplatGroup
layout(std430, binding = kOccludersBinding) readonly buffer Occluders { uint occluder_count; uint pad3, pad4, pad5; ivec4 occluders[]; };

const float kHalfVoxel = 0.5;

void main() {
  GpuView view = views[work_group().y];
  DepthMapInfo info = depth_map_infos[work_group().y];
  uint first = work_group().x * uint(kSplatGroup * kSplatRun) + gl_LocalInvocationID.x;
  for (int run = 0; run < kSplatRun; ++run) {
    uint i = first + uint(run * kSplatGroup);
    if (i >= occluder_count) return;
    vec3 p = project(view, vec3(occluders[i].xyz));
    if (p.z <= 1.0) continue;
    vec2 centre = (p.xy / p.z + 0.5) * info.scale.x;
    float radius = kHalfVoxel * view.centre.w / p.z * info.scale.x;
    ivec2 low = max(ivec2(floor(centre - radius)), ivec2(0));
    ivec2 high = min(ivec2(floor(centre + radius)), info.size.xy - 1);
    uint bits = floatBitsToUint(p.z);
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x)
        lower_depth(info, ivec2(x, y), bits);
  }
}
