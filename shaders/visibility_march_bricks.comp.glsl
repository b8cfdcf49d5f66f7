#version 450 core
#extension GL_GOOGLE_include_directive : require
// Depth and brick of the first voxel on each texel's ray through a volume: whole bricks are skipped
// where nothing is stored, hit at once where all is inside, and walked voxel by voxel else
// [AmanatidesWoo87]. One thread a texel. Reference: visibility::VoxelRays.
#include "include/dispatch.glsl"
#include "include/visibility_map.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = kMarchTableBinding) readonly buffer Table { uint table[]; };
layout(std430, binding = kMarchOccupancyBinding) readonly buffer Occupancy { uint occupancy[]; };
layout(r32f, binding = kMarchDepthsUnit) writeonly uniform image2DArray depths;
layout(r32ui, binding = kMarchIdsUnit) writeonly uniform uimage2DArray ids;
layout(location = 0) uniform ivec3 bricks;       // of the grid
layout(location = 1) uniform vec3 viewpoint;     // voxels, corner of voxel (0, 0, 0) at 0
layout(location = 2) uniform vec3 ray_x;         // direction = X ray_x + Y ray_y + ray_1, voxels a
layout(location = 3) uniform vec3 ray_y;         //   unit of depth
layout(location = 4) uniform vec3 ray_1;

const uint kOutside = 0xffffffffu, kInside = 0xfffffffeu;

// Walks the cells of `edge` voxels from t to `end`; calls for what to do are the two loops below.
struct Walk {
  ivec3 cell;
  ivec3 towards;
  vec3 next;   // t at which the next cell along each axis begins
  vec3 delta;
};

Walk start_walk(vec3 origin, vec3 direction, float t, float edge, ivec3 low, ivec3 high) {
  Walk w;
  vec3 p = (origin + t * direction) / edge;
  w.cell = clamp(ivec3(floor(p)), low, high);
  w.towards = ivec3(sign(direction));
  vec3 inverse = 1.0 / mix(direction, vec3(1e-30), equal(direction, vec3(0.0)));
  w.delta = abs(inverse) * edge;
  vec3 wall = vec3(w.cell) + vec3(greaterThan(direction, vec3(0.0)));
  w.next = mix((wall * edge - origin) * inverse, vec3(1e30), equal(direction, vec3(0.0)));
  return w;
}

// Moves on to the next cell; returns the t at which it begins.
float advance(inout Walk w) {
  int axis = w.next.x <= w.next.y ? (w.next.x <= w.next.z ? 0 : 2) : (w.next.y <= w.next.z ? 1 : 2);
  float t = w.next[axis];
  w.next[axis] += w.delta[axis];
  w.cell[axis] += w.towards[axis];
  return t;
}

bool occupied(uint slot, ivec3 local) {
  uint offset = uint((local.x << 6) | (local.y << 3) | local.z);
  return (occupancy[slot * 16u + (offset >> 5u)] & (1u << (offset & 31u))) != 0u;
}

// t of the first voxel in a brick, or a negative number.
float walk_brick(vec3 direction, float t, float end, ivec3 brick, uint slot) {
  ivec3 low = brick * 8, high = low + 7;
  Walk w = start_walk(viewpoint, direction, t, 1.0, low, high);
  while (t <= end) {
    if (occupied(slot, w.cell - low)) return t;
    t = advance(w);
    if (any(lessThan(w.cell, low)) || any(greaterThan(w.cell, high))) break;
  }
  return -1.0;
}

void main() {
  ivec2 texel = ivec2(invocation().xy);
  if (any(greaterThanEqual(texel, map_info.size.xy))) return;
  vec2 at = vec2(texel) + 0.5;
  vec3 direction = at.x * ray_x + at.y * ray_y + ray_1;
  vec3 safe = mix(direction, vec3(1e-30), equal(direction, vec3(0.0)));
  vec3 a = -viewpoint / safe, b = (vec3(bricks * 8) - viewpoint) / safe;
  vec3 first = min(a, b), last = max(a, b);
  float t = max(max(max(first.x, first.y), first.z), 0.0), end = min(min(last.x, last.y), last.z);
  float depth = uintBitsToFloat(0x7f800000u);
  uint id = kNoTriangle;
  if (t <= end) {
    Walk w = start_walk(viewpoint, direction, t, 8.0, ivec3(0), bricks - 1);
    for (;;) {
      uint index = uint((w.cell.z * bricks.y + w.cell.y) * bricks.x + w.cell.x), slot = table[index];
      float leave = min(min(w.next.x, w.next.y), w.next.z);
      float hit = slot == kInside ? t : slot == kOutside ? -1.0 : walk_brick(direction, t, leave, w.cell, slot);
      if (hit >= 0.0) {
        depth = hit;
        id = index;
        break;
      }
      t = advance(w);
      if (any(lessThan(w.cell, ivec3(0))) || any(greaterThanEqual(w.cell, bricks))) break;
    }
  }
  imageStore(depths, ivec3(texel, 0), vec4(depth));
  imageStore(ids, ivec3(texel, 0), uvec4(id));
}
