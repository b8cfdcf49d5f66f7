// Pictures for people, as files and pages have them.
#pragma once

#include <cstdint>
#include <vector>

namespace photohull {

/// 8-bit sRGB, row-major from the top-left, 3 bytes a pixel.
struct RgbImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

}  // namespace photohull
