#version 450 core
#extension GL_GOOGLE_include_directive : require
// Projective texture mapping onto squares of any place and orientation, one thread each: what the
// square's view shows on it, by the sampler that SAMPLER_... chooses.
// Reference: projtex::reference::sample_square.
#include "include/dispatch.glsl"
#include "include/sample_image.glsl"

layout(local_size_x = kSquareGroup) in;
layout(std430, binding = kSquaresBinding) readonly buffer Squares { PlaneSquare squares[]; };
layout(std430, binding = kSquareSamplesBinding) writeonly buffer Samples { vec4 samples[]; };  // as resolve() has them
uniform int count;

void main() {
  int id = int(invocation().x);
  if (id >= count) return;
  PlaneSquare square = squares[id];
  uint v = uint(square.centre.w);
  GpuView view = views[v];
  vec3 at = project(view, square.centre.xyz);
  vec3 by_u = project_step(view, square.u.xyz), by_v = project_step(view, square.v.xyz);
  samples[id] = resolve(sample_square(view, v, at, by_u, by_v));
}
