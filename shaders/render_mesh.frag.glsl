#version 450 core
#extension GL_GOOGLE_include_directive : require
// The vertices' colours, or the texture's with TEXTURED, as they are, and clay under a headlight and
// a soft light from the upper left; both sRGB-encoded. The side light is what shows how smooth the
// surface is, and its shadows how deep hollows are.
#include "include/visibility_test.glsl"
#include "shared/mesh_pages.h"

layout(location = 0) in vec3 camera_normal;
layout(location = 1) in vec3 vertex_colour;
layout(location = 2) in vec3 mesh_position;
layout(location = 3) in vec3 mesh_normal;
layout(location = 0) out vec4 coloured;
layout(location = 1) out vec4 clay;

#ifdef TEXTURED
layout(binding = kMeshPagesUnit) uniform sampler2DArray pages;

vec3 encoded(vec3 linear) {
  return mix(12.92 * linear, 1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055,
             greaterThan(linear, vec3(0.0031308)));
}

vec3 surface_colour() {
  return encoded(texture(pages, vec3(vertex_colour.xy, floor(vertex_colour.z + 0.5))).rgb);
}
#else
vec3 surface_colour() { return vertex_colour; }
#endif

const vec3 kClay = vec3(0.62, 0.59, 0.55);  // linear
const float kShaded = 0.35;  // of the side light, which is large, gets round what hides it
const vec3 kSideLight = vec3(-0.66, -0.56, -0.5);  // towards the light; y points down

void main() {
  vec3 n = normalize(camera_normal);
  float headlight = max(-n.z, 0.0);
  float facing = dot(n, kSideLight);
  float side = max(0.8 * facing + 0.2, 0.0);  // wraps around: a large, soft light
  Receiver r = Receiver(vec4(mesh_position, 1.0), vec4(normalize(mesh_normal), 0.0), vec4(0.0),
                        vec4(0.0), uvec4(kNoTriangle));
  // What turns away from the light is dark anyway, and would shade itself in the grain of the map.
  side *= mix(1.0, mix(kShaded, 1.0, visible(r)), smoothstep(0.0, 0.3, facing));
  vec3 light = kClay * (0.04 + 0.35 * headlight + 0.75 * side);
  coloured = vec4(surface_colour(), 1.0);
  clay = vec4(sqrt(light), 1.0);  // gamma 2 is close enough to sRGB for an invented material
}
