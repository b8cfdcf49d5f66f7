// The depth test at a map position: is the receiver's depth there, or in the middle of the texel with
// ALIGN_TEXEL, no greater than the map's?
// Reference: visibility::reference::Map::lit.
bool lit(Receiver r, vec2 prepared, MapPoint m, vec2 at) {
  ivec3 texel = texel_at(m, at);
#if defined(ALIGN_TEXEL)
  at = vec2(texel.xy) + 0.5;
#endif
  return receiver_depth(prepared, m, at) <= map_depth(r, m, texel);
}
