#version 450 core
#extension GL_GOOGLE_include_directive : require
// Coverage detection [Li17]: links to each texel its own triangle and those of its 8 neighbours that hold
// one of its corners, up to four. One thread a texel. Reference: visibility::reference::Map::links_of.
#include "include/visibility_map.glsl"
#include "include/visibility_triangle.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 5) readonly buffer Nearest { uint nearest[]; };
layout(rgba32ui, binding = 0) writeonly uniform uimage2DArray links;

uint nearest_at(int part, ivec2 texel) {
  if (any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, map_info.size.xy))) return kNoTriangle;
  return nearest[(part * map_info.size.y + texel.y) * map_info.size.x + texel.x];
}

bool holds_corner(MapTriangle t, ivec2 texel) {
  for (int k = 0; k < 4; ++k)
    if (contains(t, vec2(texel) + vec2(k & 1, k >> 1))) return true;
  return false;
}

ivec2 beside(int k) { return ivec2(k % 3 - 1, k / 3 - 1); }

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  int part = int(gl_GlobalInvocationID.z);
  if (any(greaterThanEqual(texel, map_info.size.xy))) return;
  uvec4 found = uvec4(nearest_at(part, texel), kNoTriangle, kNoTriangle, kNoTriangle);
  int count = found.x == kNoTriangle ? 0 : 1;
  // Most texels have the triangle of all their neighbours: only others are looked at, one a turn.
  uint others = 0u;
  for (int k = 0; k < 9; ++k) {
    uint triangle = nearest_at(part, texel + beside(k));
    if (triangle != kNoTriangle && triangle != found.x) others |= 1u << k;
  }
  do {
    int k = others == 0u ? 4 : findLSB(others);
    others &= others - 1u;
    uint triangle = nearest_at(part, texel + beside(k));
    if (triangle != kNoTriangle && !any(equal(found, uvec4(triangle))) &&
        holds_corner(triangle_of(part, triangle), texel))
      found[count++] = triangle;
  } while (others != 0u && count < kMaxLinks);
  imageStore(links, ivec3(texel, part), found);
}
