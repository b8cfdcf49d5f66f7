#version 450 core
#extension GL_GOOGLE_include_directive : require
// Depth, and with DRAW_IDS the triangle, with DRAW_BRICKS the brick of its voxel. DRAW_SLOPE adds the slope-scaled bias; DRAW_SECOND passes
// over the nearest surface (depth peeling [Everitt01]).
#include "include/visibility_map.glsl"
layout(location = 0) in float linear_depth;
layout(location = 0) out float depth;
#if defined(DRAW_BRICKS)
layout(std430, binding = kFaceBricksBinding) readonly buffer FaceBricks { uint face_bricks[]; };  // of pairs of triangles
#define DRAW_IDS
#endif
#if defined(DRAW_IDS)
layout(location = 1) out uint id;
#endif
#if defined(DRAW_SECOND)
layout(binding = kFirstDepthUnit) uniform sampler2DArray nearest_depth;
layout(location = 0) uniform int part;
const float kSameDepth = 2e-6;  // relative: surfaces no farther apart are one
#endif

void main() {
#if defined(DRAW_SECOND)
  float first = texelFetch(nearest_depth, ivec3(gl_FragCoord.xy, part), 0).r;
  if (linear_depth <= first * (1.0 + kSameDepth)) discard;
#endif
  depth = linear_depth;
#if defined(DRAW_SLOPE)
  depth += map_info.bias.y * max(abs(dFdx(linear_depth)), abs(dFdy(linear_depth)));
#endif
#if defined(DRAW_IDS)
#if defined(DRAW_BRICKS)
  id = face_bricks[gl_PrimitiveID / 2];
#else
  id = uint(gl_PrimitiveID);
#endif
#endif
}
