#version 450 core
#extension GL_GOOGLE_include_directive : require
// The vertices' colours as they are, and clay under a headlight and a soft light from the upper
// left; both sRGB-encoded. The side light is what shows how smooth the surface is.
layout(location = 0) in vec3 camera_normal;
layout(location = 1) in vec3 vertex_colour;
layout(location = 0) out vec4 coloured;
layout(location = 1) out vec4 clay;

const vec3 kClay = vec3(0.62, 0.59, 0.55);  // linear
const vec3 kSideLight = vec3(-0.66, -0.56, -0.5);  // towards the light; y points down

void main() {
  vec3 n = normalize(camera_normal);
  float headlight = max(-n.z, 0.0);
  float side = max(0.8 * dot(n, kSideLight) + 0.2, 0.0);  // wraps around: a large, soft light
  vec3 light = kClay * (0.04 + 0.35 * headlight + 0.75 * side);
  coloured = vec4(vertex_colour, 1.0);
  clay = vec4(sqrt(light), 1.0);  // gamma 2 is close enough to sRGB for an invented material
}
