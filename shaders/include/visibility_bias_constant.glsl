// z_bias = z_offset [Williams78].
float map_depth(Receiver r, MapPoint m, ivec3 texel) {
  return texelFetch(first_depth, texel, 0).r + map_info.bias.x;
}
