#include "core/image.h"

#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "core/error.h"

namespace photohull {
namespace {

/// Light of all codes of 8 bits.
const std::array<float, 256>& light_of_codes() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> t{};
    for (std::size_t i = 0; i < t.size(); ++i) t[i] = float(linear_from_srgb(double(i) / 255.0));
    return t;
  }();
  return table;
}

}  // namespace

double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

glm::vec4 ColourImage::linear(int x, int y) const {
  PHOTOHULL_CHECK(x >= 0 && y >= 0 && x < width && y < height);
  const std::uint8_t* pixel = bytes.data() + (std::size_t(y) * width + x) * bytes_per_pixel();
  if (encoding == Encoding::kSrgb8) {
    const std::array<float, 256>& light = light_of_codes();
    return {light[pixel[0]], light[pixel[1]], light[pixel[2]], pixel[3] / 255.0f};
  }
  std::uint16_t half[4];
  std::memcpy(half, pixel, sizeof half);
  return {glm::unpackHalf1x16(half[0]), glm::unpackHalf1x16(half[1]), glm::unpackHalf1x16(half[2]),
          glm::unpackHalf1x16(half[3])};
}

}  // namespace photohull
