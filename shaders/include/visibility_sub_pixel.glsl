// Sub-pixel shadow maps [Lecocq14]: the triangles of the receiver's texel and of the 8 around it decide
// where they lie at its position; else the texels around do.
// Reference: visibility::reference::Map::sub_pixel.

float fraction_visible(Receiver r, MapPoint m) {
  ivec2 centre = texel_at(m, m.at).xy;
  for (int k = 0; k < 9; ++k) {
    ivec2 texel = clamp(centre + ivec2(k % 3 - 1, k / 3 - 1), ivec2(0), map_info.size.xy - 1);
    if (hides(r, m, nearest_triangles[index_of(m.part, texel)], m.at, map_info.bias.x)) return 0.0;
  }
  return surrounded(r, m) ? 0.0 : 1.0;
}
