// Least-squares matching of patches [Gruen85].
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace photohull {

/// Brightness, row-major.
struct GreyImage {
  int width = 0, height = 0;
  std::vector<float> values;

  bool holds(double x, double y) const {
    return x >= 0 && y >= 0 && x < width - 1 && y < height - 1;
  }
  /// Bilinear; the position must be held.
  double at(double x, double y) const {
    const int i = int(x), j = int(y);
    const double u = x - i, v = y - j;
    const float* p = &values[std::size_t(j) * width + i];
    return (1 - v) * ((1 - u) * p[0] + u * p[1]) + v * ((1 - u) * p[width] + u * p[width + 1]);
  }
};

/// Position and affine shape of a patch: image position = center + shape * patch position.
struct PatchPlace {
  glm::dvec2 center{0.0};
  glm::dmat2 shape{1.0};
};

struct AlignedPatch {
  PatchPlace place;
  double agreement = 0;  ///< normalised cross-correlation
};

/// Finds the patch of radius `radius` around `source` in `image`, from the place where `start` has
/// it in `other`, over affine warps, gain and offset by Gauss-Newton. Nothing where it leaves the
/// image, has less than `least_gradient` levels a pixel (root mean square) in the weaker of two
/// directions, or does not converge within `farthest` pixels.
std::optional<AlignedPatch> align_patch(const GreyImage& image, const glm::dvec2& source,
                                        const GreyImage& other, const PatchPlace& start, int radius,
                                        double farthest, double least_gradient = 0.3);

}  // namespace photohull
