// Double-precision reference of the kernel that fits patches, written from the definitions.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "refine/fit_patches.h"
#include "refine/match_reference.h"

namespace photohull::refine::reference {

struct FitSurfel {
  glm::dvec3 position{0.0}, normal{0.0};  ///< voxel coordinates; unit
  glm::dvec3 curvature{0.0};              ///< along uu, uv, vv of tangent_axes(normal), 1 / voxel
  bool hold_out = false;
};

struct FittedPatch {
  glm::dvec3 normal{0.0};
  double offset = 0;
  /// 1 / voxel^2: the Gauss-Newton matrix over the variance about the mean, the slopes
  /// marginalised, less what noise makes of it
  double information = 0;
  double score = kNoScore, held_before = kNoScore, held_after = kNoScore;
};

/// A patch fitted to the chosen views (refine_fit_patches.comp.glsl).
///
/// The point of tap (i, j), -2 <= i, j <= 2 and i + j even, is position + i u + j v + (d + a i + b
/// j + q(i, j)) n with the tangents u, v of the length that matching gives them, the parameters (d,
/// a, b) and the height q of the curvature; each view sees it by the derivatives of its projection
/// at position + d n. A view's value there is the mean of two bilinear samples of square-root
/// encoded colour, half a texel of the tap's mip level to both sides along the image of n, and its
/// derivative their difference. x_v, 39 values of all taps, is centred per channel and divided by
/// the root of the sum of its squares and the noise's.
///
/// Views count in their order with w_v = t^2, t the correlation of x_v with the mean of those
/// before it, mapped from [least_score, full_score] to [0, 1]; the first in front of whose camera
/// the patch lies has w = 1. The cost is half the sum over views of w_v |x_v - mean|^2; its
/// gradient and Gauss-Newton matrix for fixed w, with the slopes kept near 0 by a prior and
/// Levenberg's damping, give the steps. One that lowers the score, the mean over the views of the
/// greater of correlation and least_score, is taken back and the damping raised.
FittedPatch fit_patch(std::span<const MatchView> views, std::span<const int> chosen,
                      const FitSurfel& surfel, double noise_sigma, const FitOptions& options);

}  // namespace photohull::refine::reference
