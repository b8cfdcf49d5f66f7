// Addresses on a layer of the sweep.
#include "shared/sweep.h"

layout(std140, binding = kSweepParametersBinding) uniform Parameters { SweepParameters parameters; };

// Voxel coordinates (they may be fractional) of a position on a layer.
vec3 layer_point(vec2 uv, float layer) {
  vec3 p;
  float last = float(parameters.bricks[parameters.axes.z] * 8 - 1);
  p[parameters.axes.x] = uv.x;
  p[parameters.axes.y] = uv.y;
  p[parameters.axes.z] = parameters.axes.w > 0 ? layer : last - layer;
  return p;
}

ivec3 layer_voxel(ivec2 uv, int layer) {
  ivec3 p;
  p[parameters.axes.x] = uv.x;
  p[parameters.axes.y] = uv.y;
  p[parameters.axes.z] =
      parameters.axes.w > 0 ? layer : parameters.bricks[parameters.axes.z] * 8 - 1 - layer;
  return p;
}

uint column_index(ivec2 uv) {
  return uint((uv.y - parameters.layer.y) * parameters.bricks[parameters.axes.x] * 8 + uv.x);
}
