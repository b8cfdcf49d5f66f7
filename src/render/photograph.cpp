#include "render/photograph.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace photohull::render {
namespace {

constexpr int kEncodeSteps = 8192;  // fine enough for the steep start of the curve

glm::vec3 linear_pixel(const ColourImage& image, int x, int y) {
  x = std::clamp(x, 0, image.width - 1);
  y = std::clamp(y, 0, image.height - 1);
  if (image.encoding != ColourImage::Encoding::kSrgb8) return glm::vec3(image.linear(x, y));
  const std::uint8_t* p = &image.bytes[(std::size_t(y) * image.width + x) * 4];
  return {decode_srgb(p[0]), decode_srgb(p[1]), decode_srgb(p[2])};
}

/// `at` in pixels.
glm::vec3 bilinear(const ColourImage& image, const glm::dvec2& at) {
  const glm::ivec2 base(glm::floor(at));
  const glm::vec2 f(at - glm::dvec2(base));
  return glm::mix(
      glm::mix(linear_pixel(image, base.x, base.y), linear_pixel(image, base.x + 1, base.y), f.x),
      glm::mix(linear_pixel(image, base.x, base.y + 1), linear_pixel(image, base.x + 1, base.y + 1),
               f.x),
      f.y);
}

/// Mean over the pixels whose centres lie in a rectangle larger than a pixel.
glm::vec3 mean(const ColourImage& image, const glm::dvec2& low, const glm::dvec2& high) {
  const glm::ivec2 first(glm::ceil(low)), end(glm::ceil(high));
  glm::vec3 sum(0);
  for (int y = first.y; y < end.y; ++y)
    for (int x = first.x; x < end.x; ++x) sum += linear_pixel(image, x, y);
  return sum / float((end.x - first.x) * (end.y - first.y));
}

}  // namespace

std::uint8_t encode_srgb(float linear) {
  static const auto table = [] {
    std::array<std::uint8_t, kEncodeSteps + 1> bytes;
    for (int i = 0; i <= kEncodeSteps; ++i)
      bytes[i] = std::uint8_t(std::lround(255 * srgb_from_linear(double(i) / kEncodeSteps)));
    return bytes;
  }();
  const float clamped = std::clamp(linear, 0.0f, 1.0f);  // NaN stays NaN
  return clamped == clamped ? table[std::size_t(clamped * kEncodeSteps + 0.5f)] : 0;
}

float decode_srgb(std::uint8_t byte) {
  static const auto table = [] {
    std::array<float, 256> values;
    for (int i = 0; i < 256; ++i) values[i] = float(linear_from_srgb(i / 255.0));
    return values;
  }();
  return table[byte];
}

RgbImage cut_photograph(const ColourImage& image, double x, double y, double scale, int width,
                        int height) {
  RgbImage out{width, height, {}};
  out.rgb.reserve(std::size_t(width) * height * 3);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      const glm::dvec2 low = glm::dvec2(x + column / scale, y + row / scale);
      const glm::dvec2 high = low + 1.0 / scale;
      const glm::vec3 linear =
          scale < 1 ? mean(image, low, high) : bilinear(image, 0.5 * (low + high));
      for (int c = 0; c < 3; ++c) out.rgb.push_back(encode_srgb(linear[c]));
    }
  return out;
}

}  // namespace photohull::render
