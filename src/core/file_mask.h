// A mask as a file had it.
#pragma once

#include <utility>

#include "core/image.h"

namespace photohull {

struct FileMask : Mask {
  FileMask() = default;
  FileMask(Mask mask, bool ones = false) : Mask(std::move(mask)), from_ones(ones) {}

  bool from_ones = false;  ///< the file's values were 0 and 1, and 1 was taken for 255
};

}  // namespace photohull
