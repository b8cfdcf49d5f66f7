// Sub-pixel shadow maps [Lecocq14]: the triangles of the receiver's texel and of the 8 around it decide
// where they lie at its position; else conservative depths do.
// Reference: visibility::reference::Map::sub_pixel.

float fraction_visible(Receiver r, MapPoint m) {
  ivec2 centre = texel_at(m, m.at).xy;
  bool known = false;
  for (int k = 0; k < 9; ++k) {
    ivec2 texel = clamp(centre + ivec2(k % 3 - 1, k / 3 - 1), ivec2(0), map_info.size.xy - 1);
    int found = verdict(r, m, nearest_triangles[index_of(m.part, texel)]);
    if (found == 0) return 0.0;
    known = known || found == 1;
  }
  return known || !surely_hidden(r, m) ? 1.0 : 0.0;
}
