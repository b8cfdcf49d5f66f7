// Summed-area table [Crow84]: the exact integral over an upright rectangle with the footprint's second
// moments. Entries are sums of 16-bit values modulo 2^32, so that differences lose nothing, however
// far they are from the corner. Reference: projtex::reference::sample_footprint.
layout(binding = kImageSumsUnit) uniform usampler2DArray sums;
uniform float sum_unit;  // linear light of one unit

const float kWidestBox = 128.0;  // pixels: its sum fits 32 bits

uvec4 sum_at(Footprint f, int x, int y) {
  ivec2 last = textureSize(sums, 0).xy - 1;
  return texelFetch(sums, ivec3(clamp(ivec2(x, y), ivec2(0), last), int(f.scale.z)), 0);
}

// Along each axis the box is the whole pixels between its ends, with what the high end adds to the
// pixel that it lies in and without what the low end leaves out of its own.
vec4 sample_image(Footprint f) {
  vec2 half_side = 0.5 * clamp(upright_sides(f), vec2(kLeastWidth), vec2(kWidestBox));
  vec2 middle = clamp(f.pixel, vec2(-kFarthest), vec2(kFarthest)) + 0.5;
  vec2 low = middle - half_side, high = middle + half_side;  // of pixels' corners
  vec2 a = floor(low), b = floor(high);
  ivec4 x = ivec4(a.x, a.x + 1.0, b.x, b.x + 1.0), y = ivec4(a.y, a.y + 1.0, b.y, b.y + 1.0);
  const ivec2 span[3] = ivec2[3](ivec2(0, 2), ivec2(2, 3), ivec2(0, 1));
  vec3 wx = vec3(1.0, high.x - b.x, a.x - low.x), wy = vec3(1.0, high.y - b.y, a.y - low.y);
  vec4 total = vec4(0.0);
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      ivec2 sx = span[i], sy = span[j];
      uvec4 sum = sum_at(f, x[sx.y], y[sy.y]) - sum_at(f, x[sx.x], y[sy.y]) -
                  sum_at(f, x[sx.y], y[sy.x]) + sum_at(f, x[sx.x], y[sy.x]);
      total += wx[i] * wy[j] * vec4(sum);
    }
  total /= 4.0 * half_side.x * half_side.y * 65535.0;
  return max(vec4(total.rgb * (65535.0 * sum_unit), total.a), 0.0);
}
