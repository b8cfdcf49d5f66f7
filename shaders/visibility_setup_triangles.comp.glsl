#version 450 core
#extension GL_GOOGLE_include_directive : require
// Edge functions and depth of each triangle on a partition of a map [OlanoGreer97], and a list of those
// that touch many texels. One thread a triangle. Reference: visibility::reference::Map::cross.
#include "include/dispatch.glsl"
#include "include/visibility_map.glsl"
#include "include/visibility_triangle.glsl"
#include "include/visibility_spans.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = kLargeTrianglesBinding) buffer Large { uint large_count; uint large[]; };
layout(location = 0) uniform int part;

const int kLargeRows = 64;

MapTriangle setup(uint triangle) {
  vec3 p[3];
  float w[3];
  int anchor = 0;
  for (int i = 0; i < 3; ++i) {
    p[i] = position_of(indices[3u * triangle + uint(i)]);
    w[i] = homogeneous(part, vec4(p[i], 1.0)).z;
    if (w[i] > w[anchor]) anchor = i;
  }
  MapTriangle t = MapTriangle(vec4(0.0), vec4(0.0), vec4(0.0));
  if (w[anchor] < map_info.parts[part].depth_of_w.w) return t;
  int second = (anchor + 1) % 3, third = (anchor + 2) % 3;
  vec3 h = homogeneous(part, vec4(p[anchor], 1.0));
  vec2 at = h.xy / h.z;
  vec3 a = homogeneous_step(part, at, p[second] - p[anchor]), b = homogeneous_step(part, at, p[third] - p[anchor]);
  float det = a.x * b.y - a.y * b.x;
  if (det == 0.0) return t;
  vec2 edge1 = vec2(b.y, -b.x) / det, edge2 = vec2(-a.y, a.x) / det;
  vec2 slope = (-a.z / h.z) * edge1 + (-b.z / h.z) * edge2;
  float low = 1e30, high = -1e30;
  for (int i = 0; i < 3; ++i) {
    float z = dot(map_info.parts[part].row_z, vec4(p[i], 1.0));
    low = min(low, z);
    high = max(high, z);
  }
  if (any(isinf(edge1)) || any(isinf(edge2)) || any(isinf(slope))) return t;
  return MapTriangle(vec4(at, 1.0 / h.z, 0.0), vec4(slope, edge1), vec4(edge2, max(low, 0.0), high));
}

void main() {
  uint triangle = invocation().x;
  if (triangle >= uint(map_info.size.w)) return;
  MapTriangle t = setup(triangle);
  map_triangles[part * map_info.size.w + int(triangle)] = t;
  if (t.anchor.z == 0.0) return;
  ivec2 rows = rows_of(polygon_of(part, triangle));
  if (rows.y - rows.x >= kLargeRows) large[atomicAdd(large_count, 1u)] = triangle;
}
