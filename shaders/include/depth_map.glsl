// Plain depth maps: for each camera the least linear depth (voxels) of what stands, as the bits of a
// positive float, in one buffer for all cameras.
#include "shared/sweep.h"

layout(std430, binding = 8) readonly buffer DepthMapInfos { DepthMapInfo depth_map_infos[]; };
layout(std430, binding = 9) buffer DepthMaps { uint depth_maps[]; };

// Is a point at `depth` that projects to `pixel` not hidden? Constant bias [Williams78].
bool visible(uint v, vec2 pixel, float depth, float bias) {
  DepthMapInfo info = depth_map_infos[v];
  ivec2 texel = clamp(ivec2((pixel + 0.5) * info.scale.x), ivec2(0), info.size.xy - 1);
  uint bits = depth_maps[info.size.z + texel.y * info.size.x + texel.x];
  return depth <= uintBitsToFloat(bits) + bias;
}
