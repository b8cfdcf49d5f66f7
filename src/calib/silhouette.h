// Distance to the silhouette of a mask.
#pragma once

#include <vector>

#include "core/image.h"

namespace photohull {

/// Signed distance in pixels from each pixel centre to the contour of 50 % coverage: positive
/// outside (background), negative inside. Row-major, from the top-left.
struct SilhouetteDistance {
  /// Magnitude where there is no contour at all; a half float holds it.
  static constexpr float kNoContour = 32768.0f;

  int width = 0;
  int height = 0;
  std::vector<float> pixels;
};

/// Only what the frame shows counts: a contour is never closed along the frame. A mask without
/// foreground gives +kNoContour everywhere, one without background -kNoContour.
///
/// Close to the contour the error is a few hundredths of a pixel for anti-aliased masks (coverage
/// is taken as the area that the object covers). `mask` must not be empty.
SilhouetteDistance silhouette_distance(const Mask& mask);

}  // namespace photohull
