// Pixels in main memory.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace photohull {

/// RGBA pixels, row-major from the top-left, in one of the two encodings that the GPU samples to
/// linear light: 8-bit sRGB (4 bytes a pixel) for 8-bit sources, and linear half float (8 bytes a
/// pixel) for 16-bit and floating-point sources. Alpha is linear in both: 1 where the file has
/// none.
struct ColourImage {
  enum class Encoding { kSrgb8, kLinearHalf };

  int width = 0;
  int height = 0;
  Encoding encoding = Encoding::kSrgb8;
  bool has_alpha = false;           ///< the file itself had an alpha channel
  std::vector<std::uint8_t> bytes;  ///< width * height * bytes_per_pixel()

  std::size_t bytes_per_pixel() const { return encoding == Encoding::kSrgb8 ? 4 : 8; }
  /// Linear-light RGBA of one pixel.
  glm::vec4 linear(int x, int y) const;
};

/// Foreground coverage of each pixel: 0 background, 255 object. Empty: nothing is known.
struct Mask {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> coverage;  ///< width * height

  bool empty() const { return coverage.empty(); }
};

/// sRGB transfer function (IEC 61966-2-1), encoded value in [0, 1] to linear light and back.
double linear_from_srgb(double encoded);
double srgb_from_linear(double linear);

}  // namespace photohull
