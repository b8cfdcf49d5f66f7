#version 450 core
#extension GL_GOOGLE_include_directive : require
// Does something to every texel that a triangle touches (conservative rasterisation [Hasselgren05]):
//   COVER_DEPTH   least over the triangles that cover a texel whole of their greatest depth in it
//   COVER_NEAREST least depth at the texel's centre
//   COVER_ID      the least triangle of that depth
//   COVER_COUNT   number of triangles that may be seen in it
//   COVER_FILL    their list
// One thread a triangle of at most kLargeRows rows; with COVER_LARGE one group a longer one.
// Reference: visibility::reference::Map::seen_in, nearest_in.
#include "include/dispatch.glsl"
#include "include/visibility_map.glsl"
#include "include/visibility_triangle.glsl"
#include "include/visibility_spans.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = kLargeTrianglesBinding) readonly buffer Large { uint large_count; uint large[]; };
layout(std430, binding = kCoverDepthsBinding) buffer Depths { uint depth_bits[]; };  // a texel
layout(std430, binding = kCoverWordsBinding) buffer Words { uint words[]; };        // a texel: ids, counts or where to write
layout(std430, binding = kMapListBinding) buffer List { uint list[]; };
layout(std430, binding = kMapListRestBinding) buffer ListRest { uint list_rest[]; };
layout(location = 0) uniform int part;

const int kLargeRows = 64;

void cover(uint triangle, MapTriangle t, ivec2 texel) {
  int at = (part * map_info.size.y + texel.y) * map_info.size.x + texel.x;
#if defined(COVER_DEPTH)
  for (int k = 0; k < 4; ++k)
    if (!contains(t, vec2(texel) + vec2(k & 1, k >> 1))) return;
  atomicMin(depth_bits[at], floatBitsToUint(depth_range(t, part, texel).y));
#elif defined(COVER_NEAREST)
  atomicMin(depth_bits[at], floatBitsToUint(triangle_depth(t, part, vec2(texel) + 0.5)));
#elif defined(COVER_ID)
  if (floatBitsToUint(triangle_depth(t, part, vec2(texel) + 0.5)) == depth_bits[at]) atomicMin(words[at], triangle);
#else
  if (depth_range(t, part, texel).x > uintBitsToFloat(depth_bits[at])) return;
  uint place = atomicAdd(words[at], 1u);
#if defined(COVER_FILL)
#if defined(LISTS_IN_TWO_BLOCKS)
  if (place >= map_info.lists.x)
    list_rest[place - map_info.lists.x] = triangle;
  else
#endif
    list[place] = triangle;
#endif
#endif
}

void cover_row(uint triangle, MapTriangle t, MapPolygon polygon, int row) {
  ivec2 span = span_of(polygon, row);
  for (int x = span.x; x <= span.y; ++x) cover(triangle, t, ivec2(x, row));
}

void main() {
#if defined(COVER_LARGE)
  uint triangle = large[work_group().x];
#else
  uint triangle = invocation().x;
  if (triangle >= uint(map_info.size.w)) return;
#endif
  MapTriangle t = triangle_of(part, triangle);
  if (t.anchor.z == 0.0) return;
  MapPolygon polygon = polygon_of(part, triangle);
  ivec2 rows = rows_of(polygon);
#if defined(COVER_LARGE)
  for (int row = rows.x + int(gl_LocalInvocationID.x); row <= rows.y; row += 64) cover_row(triangle, t, polygon, row);
#else
  if (rows.y - rows.x >= kLargeRows) return;
  for (int row = rows.x; row <= rows.y; ++row) cover_row(triangle, t, polygon, row);
#endif
}
