// A quick look at whether photographs agree with their cameras.
#pragma once

#include <cmath>
#include <span>

#include "cameras/frontier.h"
#include "core/prepared_view.h"
#include "core/progress.h"

namespace photohull {

struct FeatureAgreement {
  /// Median over pairs of photographs of their features' median distances from each other's
  /// epipolar lines; NaN where there is no pair.
  double pixels = NAN;
  int pairs = 0;    ///< of photographs with enough features in common
  int matches = 0;  ///< of features, in all pairs
  double suspicious =
      0.25;  ///< pixels from which on cameras look wrong; more for large photographs
};

/// Looks at six pairs of neighbouring photographs, spread over all, which takes about one CPU
/// second: SIFT features [Lowe04] of images of about 400 pixels, matched without the cameras
/// (match_freely) and then aligned in the photographs themselves [Gruen85], which are made smaller
/// where they have more than 1600 pixels. A camera that is off
/// alone is seen where it is in a pair; what moves points along epipolar lines is not. Views are
/// undistorted. Throws Cancelled.
FeatureAgreement look_at_features(std::span<const PreparedView> views, Progress& progress);

/// Median distance in pixels of the outlines' tangents from each other's epipolar lines, over all
/// pairs of views with masks (frontier_pairs); NaN where there is no pair. Says in some hundredths
/// of a second whether refine_cameras may pay.
double tangent_disagreement(std::span<const PreparedView> views);
/// The same, of outlines that are known (outlines_of).
double tangent_disagreement(std::span<const Camera> cameras, std::span<const Outline> outlines);

/// How far cameras are off by outlines, where these tell, or by features; 0 where neither does.
double pixels_off(std::span<const PreparedView> views, Progress& progress);

}  // namespace photohull
