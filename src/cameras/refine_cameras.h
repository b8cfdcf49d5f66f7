// Cameras that are slightly wrong, made consistent with the photographs.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cameras/feature_tracks.h"
#include "core/box.h"
#include "core/describe.h"

namespace photohull {

/// What all views share and is refined once poses have settled.
enum class SharedIntrinsics {
  kNone,
  kPixelCentre,  ///< an offset of all principal points, in x and y: another pixel centre
  kAll,          ///< that, and a factor of all focal lengths
  kWhereAlike    ///< kAll where poses alone would have to move most views alike, else kNone
};

/// Which features are used.
enum class TrackSource {
  kBoth,   ///< those given, and found ones elsewhere
  kGiven,  ///< RefineCamerasOptions::given only
  kFound
};

const char* to_string(TrackSource source);

struct RefineCamerasOptions {
  SharedIntrinsics intrinsics = SharedIntrinsics::kNone;
  TrackSource source = TrackSource::kBoth;
  /// Views whose cameras agree with one another: these stay as they are, and hold the others. Then
  /// there is no gauge to fix. Not together with `intrinsics`.
  std::vector<int> held;
  std::vector<Track> given;  ///< by another program (undistorted_tracks), in the views' pixels
  /// Where the object is. With it, and masks, patches of the hull's surface (patch_tracks) join
  /// where a view has few features.
  std::optional<Box> box;
  int few_features = 100;  ///< observations of a view, in the median
  /// Poses have six unknowns a view: some hundred observations determine them.
  TrackOptions tracks{.features = 1500, .enough = 300};
};

/// Those that are no matter of what is known of the scene.
void describe(Described& to, RefineCamerasOptions& options);

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
  double moved = 0;           ///< pixels, by poses: root mean square over tracks' points and views
  double moved_alike = 0;     ///< pixels, what poses moved all views by alike: their mean's length
  double focal_factor = 1;    ///< of the given focal lengths
  glm::dvec2 principal{0.0};  ///< pixels added to the given principal points
  int tracks = 0, tangents = 0, rounds = 0;
  int given_tracks = 0, patches = 0;  ///< among the tracks
};

/// Bundle adjustment [Triggs99] of poses, and with `intrinsics` what all views share, over
/// feature tracks (find_tracks, patch_tracks) and silhouettes' tangents (frontier_pairs; views with
/// masks), by Ceres with robust losses whose widths follow the residuals. The gauge is fixed: the
/// result is moved, turned and scaled to where the given poses, with the refined intrinsics, have
/// the points. A round is only accepted when what was held out agrees better after it, judged by
/// residuals weighed against their spread in the round before. Where errors of poses could be one
/// error of what all views share, kWhereAlike takes the latter if by the Bayesian information
/// criterion [Schwarz78] it spares the poses enough motion. Views are undistorted. Throws
/// Cancelled, and Error for fewer than three views.
CameraRefinement refine_cameras(std::span<const PreparedView> views,
                                const RefineCamerasOptions& options, Progress& progress);

}  // namespace photohull
