#version 450 core
#extension GL_GOOGLE_include_directive : require
// The triangles that coverage detection links to one texel. One thread.
// Reference: visibility::reference::Map::links_of.
#include "include/visibility_map.glsl"
#include "include/visibility_receiver_plane.glsl"
#include "include/visibility_triangle.glsl"
#include "include/visibility_nearest.glsl"
#include "include/visibility_links.glsl"

layout(local_size_x = 1) in;
layout(std430, binding = kLinksBinding) writeonly buffer Links { uvec4 links; };
layout(location = 0) uniform ivec3 texel;  // z: partition

void main() { links = links_of(texel.z, texel.xy); }
