#version 450 core
#extension GL_GOOGLE_include_directive : require
// Triangles onto a partition of a visibility map. Depth is hyperbolic for the depth test only (greater
// is nearer); what is stored is linear. Reference: visibility::reference::Map.
#include "include/visibility_map.glsl"
layout(location = 0) in vec3 position;
layout(location = 0) out float linear_depth;
layout(location = 0) uniform int part;

void main() {
  vec4 p = vec4(position, 1.0);
  vec3 h = homogeneous(part, p);
  linear_depth = dot(map_info.parts[part].row_z, p);
  gl_Position = vec4(2.0 * h.xy / vec2(map_info.size.xy) - h.z, map_info.parts[part].depth_of_w.w, h.z);
}
