// Plain depth maps: for each camera the least linear depth (voxels) of what stands, as the bits of a
// positive float: in one buffer for all cameras, or where that is larger than a storage block, with
// DEPTH_MAPS_LAYERED, in the layers of an image.
#include "shared/depth_map.h"

layout(std430, binding = kDepthMapInfosBinding) readonly buffer DepthMapInfos { DepthMapInfo depth_map_infos[]; };
#if defined(DEPTH_MAPS_LAYERED)
layout(binding = kDepthMapLayersUnit, r32ui) uniform uimage2DArray depth_map_layers;

uint depth_bits(DepthMapInfo info, ivec2 texel) {
  return imageLoad(depth_map_layers, ivec3(texel, info.size.z)).x;
}

void lower_depth(DepthMapInfo info, ivec2 texel, uint bits) {
  imageAtomicMin(depth_map_layers, ivec3(texel, info.size.z), bits);
}
#else
layout(std430, binding = kDepthMapsBinding) buffer DepthMaps { uint depth_maps[]; };

uint depth_bits(DepthMapInfo info, ivec2 texel) {
  return depth_maps[info.size.z + texel.y * info.size.x + texel.x];
}

void lower_depth(DepthMapInfo info, ivec2 texel, uint bits) {
  atomicMin(depth_maps[info.size.z + texel.y * info.size.x + texel.x], bits);
}
#endif

// Is a point at `depth` that projects to `pixel` not hidden? Constant bias [Williams78].
bool visible(uint v, vec2 pixel, float depth, float bias) {
  DepthMapInfo info = depth_map_infos[v];
  ivec2 texel = clamp(ivec2((pixel + 0.5) * info.scale.x), ivec2(0), info.size.xy - 1);
  return depth <= uintBitsToFloat(depth_bits(info, texel)) + bias;
}
