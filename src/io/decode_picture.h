// Pictures in memory, as files of other kinds hold them.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/rgb_image.h"

namespace photohull::io {

/// Decodes a PNG or JPEG of 8 bits a channel, grey or in colours; an alpha channel is left out.
/// Throws Error that begins with `name` where it is none, damaged, or larger than kMaxImagePixels.
RgbImage decode_picture(std::span<const std::uint8_t> bytes, const std::string& name);

}  // namespace photohull::io
