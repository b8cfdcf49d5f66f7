// Pixels as a JPEG file in memory.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace photohull::io {

/// `rgb` holds width * height * 3 values, 8-bit sRGB, row-major from the top-left; `quality` is
/// libjpeg's, 1 to 100. The same pixels give the same bytes. Throws Error when there is no memory.
std::vector<std::uint8_t> encode_jpeg(int width, int height, std::span<const std::uint8_t> rgb,
                                      int quality);

}  // namespace photohull::io
