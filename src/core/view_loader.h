// How photographs and masks are read.
#pragma once

#include <filesystem>
#include <functional>

#include "core/file_mask.h"
#include "core/image.h"

namespace photohull {

/// Lets the modules that ask for pixels stay free of image formats. Both are called from several
/// threads at once and throw Error for files that cannot be read.
struct ViewLoader {
  std::function<ColourImage(const std::filesystem::path&)> image;
  std::function<FileMask(const std::filesystem::path&)> mask;
};

}  // namespace photohull
