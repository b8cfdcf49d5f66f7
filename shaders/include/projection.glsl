// Projective texture mapping of one point (Segal et al. 1992).
#include "shared/view.h"

#ifdef UNIFORM_VIEWS
layout(std140, binding = kUniformViewsBinding) uniform Views { GpuView views[kMostUniformViews]; };
#else
layout(std430, binding = kViewsBinding) readonly buffer Views { GpuView views[]; };
#endif

// Homogeneous texture coordinates (s, t, q) of a point in voxel coordinates.
vec3 project(GpuView view, vec3 voxel) {
  vec4 p = vec4(voxel, 1.0);
  return vec3(dot(view.row_s, p), dot(view.row_t, p), dot(view.row_q, p));
}

// How they change along a step.
vec3 project_step(GpuView view, vec3 by) {
  return vec3(dot(view.row_s.xyz, by), dot(view.row_t.xyz, by), dot(view.row_q.xyz, by));
}

// The same camera with its principal point moved by `shift` pixels.
GpuView shifted(GpuView view, vec2 shift) {
  view.row_s += shift.x * view.row_q;
  view.row_t += shift.y * view.row_q;
  return view;
}

// Is the pixel position on the image? Pixel centres are integers.
bool on_image(GpuView view, vec2 pixel) {
  return all(greaterThanEqual(pixel, vec2(-0.5))) &&
         all(lessThanEqual(pixel, view.size.xy - 0.5));
}

// Normalised coordinates in the array texture of a pixel position.
vec2 texture_coordinate(GpuView view, vec2 pixel) { return (pixel + 0.5) * view.size.zw; }
