// Rows of linear light into an image's bytes. Internal to io.
#pragma once

#include <cstddef>

#include "core/image.h"

namespace photohull::io {

/// Appends rows of linear RGBA to an image, whose size and encoding are set.
class RowWriter {
 public:
  /// Makes room for its bytes.
  explicit RowWriter(ColourImage& image);

  void operator()(const float* row);

 private:
  ColourImage& image_;
  std::size_t at_ = 0;
};

}  // namespace photohull::io
