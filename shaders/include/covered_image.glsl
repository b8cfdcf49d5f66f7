// The photographs as samplers read them: linear light times coverage, and coverage; nothing beyond
// the border. Means of such texels never mix background into an object.
layout(binding = kImagesUnit) uniform sampler2DArray images;

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

// Where bilinear interpolation gives the integral over an upright box whose sides are one over `steepness`
// pixels, as far as that is at most one: the transition between pixels becomes as wide as the box.
vec2 box_position(vec2 pixel, vec2 steepness) {
  vec2 low = floor(pixel);
  return low + clamp((pixel - low - 0.5) * clamp(steepness, 1.0, 1.0 / kLeastWidth) + 0.5, 0.0, 1.0);
}
