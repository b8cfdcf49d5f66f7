// Pictures painted from functions.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <glm/gtc/packing.hpp>

#include "core/image.h"

namespace photohull {

using Paint = std::function<glm::vec3(double x, double y)>;  ///< linear light at a pixel position

/// Opaque 8-bit picture of linear colours.
inline ColourImage paint_srgb(int width, int height, const Paint& paint) {
  ColourImage image{width, height, ColourImage::Encoding::kSrgb8, false, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const glm::vec3 colour = glm::clamp(paint(x, y), 0.0f, 1.0f);
      for (int c = 0; c < 3; ++c)
        image.bytes.push_back(std::uint8_t(std::lround(255 * srgb_from_linear(colour[c]))));
      image.bytes.push_back(255);
    }
  return image;
}

/// Opaque half-float picture of linear colours.
inline ColourImage paint_half(int width, int height, const Paint& paint) {
  ColourImage image{width, height, ColourImage::Encoding::kLinearHalf, false, {}};
  image.bytes.resize(std::size_t(width) * height * 8);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::uint64_t packed = glm::packHalf4x16(glm::vec4(paint(x, y), 1.0f));
      std::memcpy(&image.bytes[(std::size_t(y) * width + std::size_t(x)) * 8], &packed, 8);
    }
  return image;
}

/// Mask whose coverage is `value(x, y)` in [0, 1].
inline Mask paint_mask(int width, int height, const std::function<double(double, double)>& value) {
  Mask mask{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      mask.coverage.push_back(std::uint8_t(std::lround(255 * std::clamp(value(x, y), 0.0, 1.0))));
  return mask;
}

}  // namespace photohull
