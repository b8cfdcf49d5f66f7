// Mipmap, trilinear between the levels around lambda [Williams83]. Lambda is the logarithm of the
// footprint's longest edge or, with LAMBDA_OF_DERIVATIVE, of the largest derivative
// [Montenegro03, 3.4.2]. Reference: projtex::reference::sample_footprint.
vec4 sample_image(Footprint f) {
#ifdef LAMBDA_OF_DERIVATIVE
  vec2 most = max(abs(f.du), abs(f.dv));
  float lambda = log2(max(max(most.x, most.y), 1.0));
#else
  float lambda = 0.5 * log2(max(max(dot(f.du, f.du), dot(f.dv, f.dv)), 1.0));
#endif
  return textureLod(images, image_coordinate(f, f.pixel), lambda);
}
