// Cameras that are slightly wrong, made consistent with the photographs.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "calib/feature_tracks.h"

namespace photohull {

struct RefineCamerasOptions {
  /// Focal length (a factor) and principal point (an offset), the same for all views, too.
  bool intrinsics = false;
  TrackOptions tracks;
  double held_out = 0.2;  ///< share of the tracks and tangents that only judge
  int rounds = 8;         ///< at most; each one finds outliers and tangents anew
};

/// How well a view agrees with the others: root mean square distances in pixels over held-out
/// observations, the same ones before and after; outliers are not among them.
struct ViewAgreement {
  double before = 0, after = 0;
  int observations = 0;
};

struct CameraRefinement {
  std::vector<Camera> cameras;  ///< as given where nothing better was found
  bool changed = false;
  std::vector<ViewAgreement> views;
  ViewAgreement all;
  double tangents_before = 0, tangents_after = 0;  ///< pixels, held-out tangents (median)
  double moved = 0;           ///< pixels, root mean square over tracks' points and views
  double focal_factor = 1;    ///< of the given focal lengths
  glm::dvec2 principal{0.0};  ///< pixels added to the given principal points
  int tracks = 0, tangents = 0, rounds = 0;
};

/// Bundle adjustment [Triggs99] of poses, and with `intrinsics` of what all views share, over
/// feature tracks (find_tracks) and silhouettes' tangents (frontier_pairs; views with masks), by
/// Ceres with robust losses whose widths follow the residuals. The gauge is fixed: the result is
/// moved, turned and scaled to where the given cameras have the points. A round is only accepted
/// when what was held out agrees better after it, judged by residuals weighed against their spread
/// in the round before.
/// Views are undistorted. Throws Cancelled, and Error for fewer than three views.
CameraRefinement refine_cameras(std::span<const View> views, const RefineCamerasOptions& options,
                                Progress& progress);

}  // namespace photohull
