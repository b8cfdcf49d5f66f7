// Where the model leaves a mask empty, as a picture.
#pragma once

#include <span>
#include <string>

#include "assess/silhouette_check.h"
#include "core/image.h"
#include "core/rgb_image.h"
#include "pipeline/self_check.h"

namespace photohull::pipeline {

struct MissingPicture : RgbImage {
  std::string view;  ///< whose photograph it is
};

/// The photograph whose mask the mesh fills worst, by `fits`, darkened: foreground that the mesh
/// does not cover is red, and what it covers beyond the silhouette that was used is blue; the
/// contour's surroundings do not count, as in check_silhouettes. Empty where no view has a mask.
MissingPicture draw_missing(const CheckedResult& result,
                            std::span<const assess::SilhouetteFit> fits);

}  // namespace photohull::pipeline
