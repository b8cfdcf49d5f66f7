// Distance to the silhouette of a mask, and its lines.
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

/// A place on the centre line of a part of the silhouette that is narrower than about two pixels:
/// a stem, a wire, a leaf seen on edge. Pixels of the mask, the centre of the first at (0, 0).
struct LinePoint {
  float x = 0, y = 0;
  float normal_x = 1, normal_y = 0;  ///< unit, across the line
  float width = 0;                   ///< pixels: the integral of the coverage across the line
};

}  // namespace photohull
