// Mipmap, bilinear at the level nearest to lambda, the logarithm of the footprint's longest edge
// [Williams83]. Reference: projtex::reference::sample_footprint.
vec4 sample_image(Footprint f) {
  float lambda = 0.5 * log2(max(max(dot(f.du, f.du), dot(f.dv, f.dv)), 1.0));
  return textureLod(images, image_coordinate(f, f.pixel), floor(min(lambda, float(kLastLevel)) + 0.5));
}
