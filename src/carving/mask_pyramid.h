// Min/max pyramids of masks: what a rectangle of pixels can hold, in four look-ups.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace photohull::carving {

/// Level 0 holds blocks of kBlock^2 pixels; each further level halves the blocks' number. Every
/// cell has the least and the greatest coverage of the pixels it covers, interleaved (min, max).
/// Cells beyond the image keep (255, 0), the neutral element. All levels have power-of-two sizes.
struct MaskPyramid {
  static constexpr int kBlock = 4;  ///< pixels

  int width = 0, height = 0;  ///< cells of level 0
  std::vector<std::vector<std::uint8_t>> levels;
};

/// Pyramid of `mask` for an array texture whose images are at most `array_width` x `array_height`.
MaskPyramid build_mask_pyramid(const Mask& mask, int array_width, int array_height);

}  // namespace photohull::carving
