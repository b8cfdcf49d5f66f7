// Unconstrained anisotropic filter: the mip level from the footprint's short axis, up to 16 taps in a
// row along the long one, each trilinear and, where it is smaller than a pixel, no wider than itself.
// Reference: projtex::reference::sample_footprint.
const float kMostTaps = 16.0;
const float kLeastTap = 0.5;  // pixels between taps
const float kFiner = 0.8408964;  // a quarter level below lambda errs least against the exact integral
const float kRound = 0.25;    // footprints longer by this share need no further tap

vec4 sample_image(Footprint f) {
  FootprintAxes axes = axes_of(f);
  // Not clamp(): compilers that see the greatest count unroll the loop and then always run all of it.
  float taps = max(min(ceil(axes.longer / max(axes.shorter, kLeastTap) - kRound), kMostTaps), 1.0);
  float share = 1.0 / taps, spacing = axes.longer * share;
  vec2 along = axes.direction * spacing;
  vec2 across = vec2(-axes.direction.y, axes.direction.x) * axes.shorter;
  vec2 steepness = inversesqrt(max(along * along + across * across, 1e-8));
  float lambda = log2(max(kFiner * max(axes.shorter, spacing), 1.0));
  vec4 sum = vec4(0.0);
  float k = 0.0;
  // Tested after the tap: software devices run a body once more where the test stands before it.
  do {
    vec2 pixel = f.pixel + along * (k + 0.5 - 0.5 * taps);
    sum += textureLod(images, image_coordinate(f, box_position(pixel, steepness)), lambda);
    k += 1.0;
  } while (k < taps);
  return sum * share;
}
