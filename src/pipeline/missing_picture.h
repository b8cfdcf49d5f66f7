// Where the model leaves a mask empty, as a picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "assess/silhouette_check.h"
#include "core/image.h"
#include "core/mesh.h"
#include "pipeline/self_check.h"

namespace photohull::pipeline {

/// 8-bit sRGB, row-major from the top-left.
struct MissingPicture {
  std::string view;  ///< whose photograph it is
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

/// The photograph whose mask the mesh fills worst, by `fits`, darkened: foreground that the mesh
/// does not cover is red, and what it covers beyond the silhouette that was used is blue; the
/// contour's surroundings do not count, as in check_silhouettes. Empty where no view has a mask.
MissingPicture draw_missing(const CheckedResult& result,
                            std::span<const assess::SilhouetteFit> fits);

}  // namespace photohull::pipeline
