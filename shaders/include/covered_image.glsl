// The photographs as samplers read them: linear light times coverage, and coverage; nothing beyond
// the border. Means of such texels never mix background into an object.
layout(binding = 0) uniform sampler2DArray images;

const int kLastLevel = 6;
const float kLeastWidth = 1.0 / 16.0;  // pixels, of the transition between two of them

vec3 image_coordinate(Footprint f, vec2 pixel) {
  return vec3((pixel + 0.5) * f.scale.xy, f.scale.z);
}

vec4 image_texel(Footprint f, ivec2 at, int level) {
  ivec2 size = textureSize(images, 0).xy >> level;
  bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size));
  vec4 value = texelFetch(images, ivec3(clamp(at, ivec2(0), size - 1), int(f.scale.z)), level);
  return inside ? value : vec4(0.0);
}

// Integral over an upright box of `width` pixels at a level, as far as that is at most one of its
// texels: bilinear interpolation whose transition between texels is as wide as the box.
vec4 box_at_level(Footprint f, vec2 pixel, vec2 width, int level) {
  float size = float(1 << level);
  vec2 at = (pixel + 0.5) / size - 0.5, low = floor(at);
  vec2 share = clamp((at - low - 0.5) / clamp(width / size, kLeastWidth, 1.0) + 0.5, 0.0, 1.0);
  return textureLod(images, vec3((low + share + 0.5) * size * f.scale.xy, f.scale.z), float(level));
}
