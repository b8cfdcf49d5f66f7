#version 450 core
#extension GL_GOOGLE_include_directive : require
// Plane sweep, step 1 of a layer: which columns must be judged here? Those whose voxel stands and is
// bare towards the cameras, and those on an open path. Everything else that stands on the layer and
// touches empty space is an occluder from now on. One work group a brick of the layer.
#include "include/dispatch.glsl"
#include "include/layer_items.glsl"
#include "include/occupancy.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = kSweepColumnsBinding) readonly buffer Columns { Column columns[]; };
// Work for the next steps: x: item; yz: bits of its 64 columns.
layout(std430, binding = kSweepSelectedBinding) buffer Selected { uint selected_count; uint pad0, pad1, pad2; uvec4 selected[]; };
layout(std430, binding = kOccludersBinding) buffer Occluders { uint occluder_count; uint pad3, pad4, pad5; ivec4 occluders[]; };

shared uint column_bits[2];

void main() {
  uint item = work_group().x;
  uint id = gl_LocalInvocationIndex;
  if (id < 2u) column_bits[id] = 0u;
  barrier();
  ivec2 uv = item_origin(item) + ivec2(gl_LocalInvocationID.xy);
  int layer = parameters.layer.x;
  ivec3 voxel = layer_voxel(uv, layer);
  bool on_path = columns[column_index(uv)].path.x >= 0;
  bool stands = standing(voxel);
  if (on_path || (stands && !standing(layer_voxel(uv, layer - 1)))) {
    atomicOr(column_bits[id >> 5u], 1u << (id & 31u));
  } else if (stands && exposed(voxel)) {
    occluders[atomicAdd(occluder_count, 1u)] = ivec4(voxel, 0);
  }
  barrier();
  if (id == 0u && (column_bits[0] | column_bits[1]) != 0u)
    selected[atomicAdd(selected_count, 1u)] = uvec4(item, column_bits[0], column_bits[1], 0u);
}
