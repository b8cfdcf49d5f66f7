#include "core/image.h"

#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "core/error.h"

namespace photohull {

double linear_from_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

double srgb_from_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

glm::vec4 ColourImage::linear(int x, int y) const {
  PHOTOHULL_CHECK(x >= 0 && y >= 0 && x < width && y < height);
  const std::uint8_t* pixel = bytes.data() + (std::size_t(y) * width + x) * bytes_per_pixel();
  if (encoding == Encoding::kSrgb8)
    return {float(linear_from_srgb(pixel[0] / 255.0)), float(linear_from_srgb(pixel[1] / 255.0)),
            float(linear_from_srgb(pixel[2] / 255.0)), pixel[3] / 255.0f};
  std::uint16_t half[4];
  std::memcpy(half, pixel, sizeof half);
  return {glm::unpackHalf1x16(half[0]), glm::unpackHalf1x16(half[1]), glm::unpackHalf1x16(half[2]),
          glm::unpackHalf1x16(half[3])};
}

}  // namespace photohull
