// Adaptive bias from the receiver's normal [Dou14]: as much as its tangent plane's depth changes from
// the middle of a texel to a corner, and the constant.

float map_depth(Receiver r, MapPoint m, ivec3 texel) {
  return texelFetch(first_depth, texel, 0).r + change_within_texel(r.normal.xyz, m) + map_info.bias.x;
}
