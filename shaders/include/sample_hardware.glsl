// The device's own anisotropic filter, given the exact Jacobian.
vec4 sample_image(Footprint f) {
  return textureGrad(images, image_coordinate(f, f.pixel), f.du * f.scale.xy, f.dv * f.scale.xy);
}
