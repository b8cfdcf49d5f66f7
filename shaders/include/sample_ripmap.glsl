// Ripmap: levels of their own along x and y, of an upright rectangle with the footprint's second
// moments; linear between texels and between levels. Level (i, j), the image averaged over 2^i x 2^j
// pixels, lies in the atlas at the offset 2 size (1 - 2^-i), 2 size (1 - 2^-j).
// Reference: projtex::reference::sample_footprint.
layout(binding = kImageRipmapsUnit) uniform sampler2DArray ripmaps;

vec4 rip_texel(Footprint f, ivec2 at, ivec2 level) {
  ivec2 full = textureSize(images, 0).xy, size = full >> level;
  bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size));
  ivec2 corner = 2 * (full - size);
  vec4 value = texelFetch(ripmaps, ivec3(corner + clamp(at, ivec2(0), size - 1), int(f.scale.z)), 0);
  return inside ? value : vec4(0.0);
}

vec4 sample_image(Footprint f) {
  vec2 lambda = clamp(log2(max(upright_sides(f), 1.0)), 0.0, float(kLastLevel));
  ivec2 fine = ivec2(lambda);
  vec4 sum = vec4(0.0);
  for (int k = 0; k < 4; ++k) {
    ivec2 step = ivec2(k & 1, k >> 1), level = min(fine + step, kLastLevel);
    vec2 rest = lambda - vec2(fine);
    float share = (step.x == 1 ? rest.x : 1.0 - rest.x) * (step.y == 1 ? rest.y : 1.0 - rest.y);
    vec2 at = (clamp(f.pixel, vec2(-kFarthest), vec2(kFarthest)) + 0.5) / vec2(ivec2(1) << level) - 0.5, low = floor(at), between = at - low;
    ivec2 i = ivec2(low);
    vec4 above = mix(rip_texel(f, i, level), rip_texel(f, i + ivec2(1, 0), level), between.x);
    vec4 below = mix(rip_texel(f, i + ivec2(0, 1), level), rip_texel(f, i + 1, level), between.x);
    sum += share * mix(above, below, between.y);
  }
  return sum;
}
