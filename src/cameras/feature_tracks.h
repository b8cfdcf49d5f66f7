// Points of the object's surface found again in several photographs.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/prepared_view.h"
#include "core/progress.h"
#include "core/scene.h"

namespace photohull {

struct Observation {
  int view = 0;
  glm::dvec2 pixel{0.0};  ///< of the view's (undistorted) camera
};

/// One surface point's positions, at most one a view, two or more.
struct Track {
  std::vector<Observation> observations;
};

struct TrackOptions {
  int features = 4000;        ///< a view at most, the most distinct ones
  int neighbours = 6;         ///< views that each one is matched with
  double largest_angle = 45;  ///< degrees between the views' directions
  double epipolar = 10;       ///< pixels: matches may lie so far from where the cameras have them
  double ratio = 0.8;         ///< of the best to the second-best descriptor's distance [Lowe04]
  int patch_radius = 7;       ///< pixels
  /// Observations of a view: tracks that no view needs for so many are left out, short ones first.
  /// 0: all stay.
  int enough = 0;
  double least_agreement = 0.8;  ///< normalised cross-correlation of patches once they are aligned
  /// Views that are matched, each pair once and ascending; empty: each one with its `neighbours`.
  std::vector<std::pair<int, int>> pairs;
  std::vector<Camera> cameras;  ///< in place of the views' own; empty: theirs
};

/// SIFT features [Lowe04] on the object (where views have masks), matched between neighbouring
/// views near the epipolar lines of the given cameras, and then aligned to the patch of one view by
/// least squares over affine warps, gain and offset [Gruen85], to hundredths of a pixel. Same
/// result whatever the number of threads. Throws Cancelled.
/// `given`: tracks that another program found, in pixels of the views; aligned in the same way, and
/// those that do not agree dropped. With `search` false there are no others; else found ones that
/// repeat a given one are left out.
std::vector<Track> find_tracks(std::span<const PreparedView> views, const TrackOptions& options,
                               Progress& progress, std::span<const Track> given = {},
                               bool search = true);

/// The scene's own tracks in pixels of its undistorted views.
std::vector<Track> undistorted_tracks(const Scene& scene, std::span<const PreparedView> views);

}  // namespace photohull
