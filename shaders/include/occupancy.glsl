// Which voxels still stand: one bit a voxel in bricks of 16 words, in the order of voxel_offset.
layout(std430, binding = kSweepTableBinding) readonly buffer Table { uint table[]; };
layout(std430, binding = kSweepOccupancyBinding) buffer Occupancy { uint occupancy[]; };

bool on_grid(ivec3 voxel) {
  return all(greaterThanEqual(voxel, ivec3(0))) &&
         all(lessThan(voxel, parameters.bricks.xyz * 8));
}

uint brick_at(ivec3 voxel) {
  ivec3 b = voxel >> 3;
  return uint((b.z * parameters.bricks.y + b.y) * parameters.bricks.x + b.x);
}

uint bit_offset(ivec3 voxel) {
  ivec3 l = voxel & 7;
  return uint((l.x << 6) | (l.y << 3) | l.z);
}

bool standing(ivec3 voxel) {
  if (!on_grid(voxel)) return false;
  uint slot = table[brick_at(voxel)];
  if (slot == 0xffffffffu) return false;
  uint offset = bit_offset(voxel);
  return (occupancy[slot * 16u + (offset >> 5u)] & (1u << (offset & 31u))) != 0u;
}

// Does any face of the voxel border on empty space?
bool exposed(ivec3 voxel) {
  return !(standing(voxel + ivec3(1, 0, 0)) && standing(voxel - ivec3(1, 0, 0)) &&
           standing(voxel + ivec3(0, 1, 0)) && standing(voxel - ivec3(0, 1, 0)) &&
           standing(voxel + ivec3(0, 0, 1)) && standing(voxel - ivec3(0, 0, 1)));
}
