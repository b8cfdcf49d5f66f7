#version 450 core
#extension GL_GOOGLE_include_directive : require
// One half of a step of the primal-dual method [Chambolle11] for the labels of space, a thread a
// voxel: with STEP_DUAL the flow between voxels follows the labels' differences, else the labels
// follow the flow's divergence and the evidence. Bricks hold 8^3 voxels, x slowest. Nothing flows to
// where there is no brick. Reference: refine::reference::label_space.
#include "include/dispatch.glsl"
#include "shared/label.h"

layout(local_size_x = 64) in;
layout(std140, binding = kLabelParametersBinding) uniform Parameters { LabelParameters parameters; };
// By brick: those beside it along +x, +y, +z, -x, -y, -z; negative where there is none.
layout(std430, binding = kLabelNeighboursBinding) readonly buffer Neighbours { int neighbours[]; };
layout(std430, binding = kLabelEvidenceBinding) readonly buffer Evidence { float evidence[]; };
layout(std430, binding = kLabelsBinding) buffer Labels { vec2 labels[]; };  // x: label, y: extrapolated
layout(std430, binding = kLabelFlowBinding) buffer Flow { vec4 flow[]; };      // xyz: to the next voxel of each axis

const ivec3 kStride = ivec3(64, 8, 1);

// Index of the voxel beside one, along an axis; negative where there is none.
int beside(int voxel, int axis, int direction) {
  int place = (voxel / kStride[axis]) & 7;
  if (place + direction >= 0 && place + direction < 8) return voxel + direction * kStride[axis];
  int brick = neighbours[6 * (voxel >> 9) + axis + (direction > 0 ? 0 : 3)];
  return brick < 0 ? -1 : (brick << 9) + (voxel & 511) - 7 * direction * kStride[axis];
}

void main() {
  int voxel = int(invocation().x);
  if (voxel >= parameters.counts.x) return;
  float rate = parameters.weights.x;
  vec3 own = flow[voxel].xyz;
#ifdef STEP_DUAL
  float label = labels[voxel].y;
  for (int axis = 0; axis < 3; ++axis) {
    int next = beside(voxel, axis, 1);
    if (next >= 0) own[axis] += rate * (labels[next].y - label);
  }
  flow[voxel] = vec4(own / max(1.0, length(own)), 0.0);
#else
  float divergence = own.x + own.y + own.z;
  for (int axis = 0; axis < 3; ++axis) {
    int before = beside(voxel, axis, -1);
    if (before >= 0) divergence -= flow[before][axis];
  }
  float label = labels[voxel].x;
  float next = clamp(label + rate * (divergence - evidence[voxel]), 0.0, 1.0);
  labels[voxel] = vec2(next, 2.0 * next - label);
#endif
}
