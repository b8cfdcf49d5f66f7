// Unconstrained anisotropic filter: the mip level from the footprint's short axis, up to 16 taps in a
// row along the long one, each trilinear and, where it is smaller than a texel, no wider than itself.
// Reference: projtex::reference::sample_footprint.
const float kMostTaps = 16.0;
const float kLeastTap = 0.5;  // pixels between taps

vec4 sample_image(Footprint f) {
  FootprintAxes axes = axes_of(f);
  float taps = clamp(ceil(axes.longer / max(axes.shorter, kLeastTap)), 1.0, kMostTaps);
  float spacing = axes.longer / taps;
  vec2 along = axes.direction * spacing;
  vec2 across = vec2(-axes.direction.y, axes.direction.x) * axes.shorter;
  vec2 width = sqrt(along * along + across * across);
  float lambda = clamp(log2(max(max(axes.shorter, spacing), 1.0)), 0.0, float(kLastLevel));
  int fine = min(int(lambda), kLastLevel - 1);
  float coarse_share = lambda - float(fine);
  vec4 sum = vec4(0.0);
  for (float k = 0.0; k < taps; k += 1.0) {
    vec2 pixel = f.pixel + along * (k + 0.5 - 0.5 * taps);
    sum += mix(box_at_level(f, pixel, width, fine), box_at_level(f, pixel, width, fine + 1), coarse_share);
  }
  return sum / taps;
}
