#version 450 core
#extension GL_GOOGLE_include_directive : require
// A bare texture-fetch loop: the device's raw sampling rate, for comparison with the sweep.
#include "include/dispatch.glsl"
#include "shared/sampling.h"
#include "shared/view.h"

layout(local_size_x = 64) in;
layout(binding = kImagesUnit) uniform sampler2DArray images;
layout(std430, binding = kFetchSumsBinding) writeonly buffer Sums { vec4 sums[]; };
uniform int taps;
uniform int layers;
uniform float lod;
uniform float lod_step;  // from tap to tap; where it is 0, a device may work out the level once for all
uniform vec4 step_and_size;  // du, dv in pixels a tap; image size in pixels

void main() {
  uint id = invocation().x;
  vec2 size = step_and_size.zw;
  vec2 at = vec2(float(id % 512u) * 0.9 + 8.0, float(id / 512u % 384u) * 0.9 + 8.0);
  vec4 sum = vec4(0.0);
  for (int layer = 0; layer < layers; ++layer)
    for (int tap = 0; tap < taps; ++tap)
      sum += textureLod(images, vec3((at + float(tap) * step_and_size.xy) / size, float(layer)),
                        lod + lod_step * float(tap));
  sums[id] = sum;
}
