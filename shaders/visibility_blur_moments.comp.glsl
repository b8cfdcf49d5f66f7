#version 450 core
#extension GL_GOOGLE_include_directive : require
// One direction of a separable Gaussian over FILTER_SIZE texels of the moments (M1, M2) of depth from 0
// (near) to 1 (far); empty texels are at 1. FROM_DEPTHS: the first pass, which makes moments of depths.
// One thread a texel. Reference: visibility::reference::Map::variance.
#include "include/dispatch.glsl"
#include "include/visibility_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBlurSourceUnit) uniform sampler2DArray source;
layout(rg32f, binding = kBlurMomentsUnit) writeonly uniform image2DArray moments;
layout(location = 0) uniform ivec2 direction;

vec2 moments_at(ivec3 texel) {
  texel.xy = clamp(texel.xy, ivec2(0), map_info.size.xy - 1);
#if defined(FROM_DEPTHS)
  float z = texelFetch(source, texel, 0).r;
  z = clamp((z - map_info.range.x) / (map_info.range.y - map_info.range.x), 0.0, 1.0);
  return vec2(z, z * z);
#else
  return texelFetch(source, texel, 0).rg;
#endif
}

void main() {
  ivec3 texel = ivec3(invocation());
  if (any(greaterThanEqual(texel.xy, map_info.size.xy))) return;
  #if !defined(FILTER_SIZE)
#define FILTER_SIZE 5
#endif
  const int radius = FILTER_SIZE / 2;
  const float sigma = 0.25 * float(FILTER_SIZE);
  vec2 sum = vec2(0.0);
  float weight = 0.0;
  for (int i = -radius; i <= radius; ++i) {
    float w = exp(-0.5 * float(i * i) / (sigma * sigma));
    sum += w * moments_at(texel + ivec3(i * direction, 0));
    weight += w;
  }
  imageStore(moments, texel, vec4(sum / weight, 0.0, 0.0));
}
