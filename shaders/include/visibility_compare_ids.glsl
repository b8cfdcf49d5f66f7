// Identity instead of depth [HourcadeNicolas85]: a receiver is seen where its triangle or brick is the
// nearest at its texel or at one beside it, or nothing nearer is there. No bias.
// Reference: visibility::reference::Map::lit.
bool lit(Receiver r, vec2 prepared, MapPoint m, vec2 at) {
  ivec3 texel = texel_at(m, at);
  if (receiver_depth(prepared, m, at) <= texelFetch(first_depth, texel, 0).r) return true;
  if (r.id.x == kNoTriangle) return false;
  for (int k = 0; k < 9; ++k) {
    ivec2 beside = clamp(texel.xy + ivec2(k % 3 - 1, k / 3 - 1), ivec2(0), map_info.size.xy - 1);
    if (texelFetch(nearest_ids, ivec3(beside, m.part), 0).r == r.id.x) return true;
  }
  return false;
}
