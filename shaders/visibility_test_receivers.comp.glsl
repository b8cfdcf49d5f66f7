#version 450 core
#extension GL_GOOGLE_include_directive : require
// How much of each receiver a viewpoint sees. One thread a receiver.
// Reference: visibility::reference::Map::visible.
#include "include/dispatch.glsl"
#include "include/visibility_test.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = kReceiversBinding) readonly buffer Receivers { Receiver receivers[]; };
layout(std430, binding = kFractionsBinding) writeonly buffer Fractions { float fractions[]; };
layout(location = 0) uniform int count;

void main() {
  if (invocation().x >= uint(count)) return;
  fractions[invocation().x] = visible(receivers[invocation().x]);
}
