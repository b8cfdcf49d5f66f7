// z_bias = z2 - z1 [WangMolnar94]: the second surface alone. Where there is none, nothing hides.
float map_depth(Receiver r, MapPoint m, ivec3 texel) {
  return texelFetch(second_depth, texel, 0).r;
}
