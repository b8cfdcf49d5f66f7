// z_bias = (z2 - z1) / 2 [Woo92]. Where there is no second surface, nothing hides.
float map_depth(Receiver r, MapPoint m, ivec3 texel) {
  return 0.5 * (texelFetch(first_depth, texel, 0).r + texelFetch(second_depth, texel, 0).r);
}
