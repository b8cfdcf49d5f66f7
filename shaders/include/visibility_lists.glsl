// Coverage without loss: every triangle that can be seen in a texel is in its list, so that the test is
// exact ray casting. Reference: visibility::reference::Map::exact.
layout(std430, binding = kMapListEndsBinding) readonly buffer ListEnds { uint list_starts[]; };  // a texel, and the end
layout(std430, binding = kMapListBinding) readonly buffer List { uint list[]; };
#if defined(LISTS_IN_TWO_BLOCKS)
layout(std430, binding = kMapListRestBinding) readonly buffer ListRest { uint list_rest[]; };

uint listed(uint i) { return i < map_info.lists.x ? list[i] : list_rest[i - map_info.lists.x]; }
#else
uint listed(uint i) { return list[i]; }
#endif

float fraction_visible(Receiver r, MapPoint m) {
  ivec2 texel = texel_at(m, m.at).xy;
  int at = (m.part * map_info.size.y + texel.y) * map_info.size.x + texel.x;
  for (uint i = list_starts[at]; i < list_starts[at + 1]; ++i) {
    uint triangle = listed(i);
    if (triangle == r.id.x) continue;
    MapTriangle t = triangle_of(m.part, triangle);
    if (contains(t, m.at) && triangle_depth(t, m.part, m.at) < m.z - map_info.bias.x) return 0.0;
  }
  return 1.0;
}
