#version 450 core
#extension GL_GOOGLE_include_directive : require
// Marks the voxels that a layer leaves behind as hiding what comes, for exact rays. One thread a voxel of
// the list. Reference: visibility::reference::sweep_visible takes such a set of voxels.
#include "include/dispatch.glsl"
#include "include/layer.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = kSweepTableBinding) readonly buffer Table { uint table[]; };
layout(std430, binding = kOccludersBinding) readonly buffer Occluders { uint occluder_count; uint pad3, pad4, pad5; ivec4 occluders[]; };
layout(std430, binding = kSweepPassedBinding) buffer Passed { uint passed[]; };

void main() {
  if (invocation().x >= occluder_count) return;
  ivec3 voxel = occluders[invocation().x].xyz, b = voxel >> 3, l = voxel & 7;
  uint slot = table[(b.z * parameters.bricks.y + b.y) * parameters.bricks.x + b.x];
  if (slot == 0xffffffffu) return;
  uint offset = uint((l.x << 6) | (l.y << 3) | l.z);
  atomicOr(passed[slot * 16u + (offset >> 5u)], 1u << (offset & 31u));
}
