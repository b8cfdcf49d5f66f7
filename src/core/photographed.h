// Pixels of prepared views that the photograph shows.
#pragma once

#include "core/image.h"

namespace photohull {

/// Undistortion leaves alpha 0 where the photograph has nothing, and masks are 255 there. Such
/// pixels are no foreground, for all that they must not be carved.
inline bool is_photographed(const ColourImage& image, int x, int y) {
  return !image.has_alpha || image.bytes.empty() || image.linear(x, y).a > 0;
}

}  // namespace photohull
