// Distance to the silhouette of a mask.
#pragma once

#include <vector>

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

}  // namespace photohull
