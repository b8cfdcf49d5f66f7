// z_bias = min((z2 - z1) / 2, z_max) [WeiskopfErtl03].
float map_depth(Receiver r, MapPoint m, ivec3 texel) {
  float z1 = texelFetch(first_depth, texel, 0).r, z2 = texelFetch(second_depth, texel, 0).r;
  return min(0.5 * (z1 + z2), z1 + map_info.bias.z);
}
