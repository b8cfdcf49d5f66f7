// Where points lie on a visibility map (shared/visibility.h).
#include "shared/visibility.h"

layout(std140, binding = kMapInfoBinding) uniform Info { MapInfo map_info; };

struct MapPoint {
  vec2 at;  // texels
  float w;  // homogeneous; depth of maps that are not warped
  float z;  // depth
  int part;
};

vec3 homogeneous(int part, vec4 p) {
  return vec3(dot(map_info.parts[part].row_x, p), dot(map_info.parts[part].row_y, p),
              dot(map_info.parts[part].row_w, p));
}

// How the position of a point that moves by `by` changes relative to (X, Y), times w.
vec3 homogeneous_step(int part, vec2 at, vec3 by) {
  vec3 step_w = map_info.parts[part].row_w.xyz;
  return vec3(dot(map_info.parts[part].row_x.xyz - at.x * step_w, by),
              dot(map_info.parts[part].row_y.xyz - at.y * step_w, by), dot(step_w, by));
}

float depth_at(int part, vec2 at, float w) {
  return w * dot(map_info.parts[part].depth_of_w.xyz, vec3(at, 1.0));
}

// The partition that serves a point.
int part_of(vec4 p) {
  bvec4 beyond = greaterThan(vec4(dot(map_info.eye_row, p)), map_info.part_ends);
  return int(beyond.x) + int(beyond.y) + int(beyond.z);
}

MapPoint locate(int part, vec3 position) {
  vec4 p = vec4(position, 1.0);
  vec3 h = homogeneous(part, p);
  return MapPoint(h.xy / h.z, h.z, dot(map_info.parts[part].row_z, p), part);
}

// Does the viewpoint have the point before it, and on its image?
bool in_view(vec3 position) {
  vec4 p = vec4(position, 1.0);
  float z = dot(map_info.parts[0].row_z, p);
  vec2 at = vec2(dot(map_info.view_x, p), dot(map_info.view_y, p));
  return z > 0.0 && all(greaterThanEqual(at, vec2(0.0))) && all(lessThanEqual(at, vec2(z)));
}

ivec3 texel_at(MapPoint m, vec2 at) {
  return ivec3(clamp(ivec2(floor(at)), ivec2(0), map_info.size.xy - 1), m.part);
}
