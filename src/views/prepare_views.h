// From a scene's files to views that are ready for carving: decoded, pinhole, with masks.
#pragma once

#include "core/describe.h"
#include "core/prepared_views.h"
#include "core/progress.h"
#include "core/scene.h"
#include "core/view_loader.h"
#include "masks/find_masks.h"

namespace photohull {

enum class MaskPolicy {
  kAuto,  ///< plate, else mask file, else alpha channel, else a background model of the photographs
  kBackground,  ///< plate, else a background model, whatever other masks there are
  kNone         ///< no masks at all, whatever the scene names
};

struct PrepareOptions {
  MaskPolicy masks = MaskPolicy::kAuto;
  /// Let OpenCV's GrabCut place the contour of masks made from the background where these leave
  /// doubt.
  bool cut_masks = false;
  /// A picture that cannot be decoded is an error; else it is left out while enough remain.
  bool strict = false;
  /// Undistorted pictures may reach at most this many times as far from the principal point as
  /// the photograph does: wide-angle corners would otherwise stretch without end.
  double max_frame_growth = 2.0;

  /// Throws UsageError for values outside their range.
  void validate() const;
};

/// Those that LoadSceneOptions do not decide.
void describe(Described& to, PrepareOptions& options);

/// Decodes in parallel (within the caller's task arena), checks sizes, finds masks and removes
/// lens distortion. Undistorted pictures keep the focal length in pixels at the principal point
/// and are resampled in linear light; views without distortion keep their bytes as decoded.
/// Views whose pictures cannot be decoded leave the scene, with a warning, as core/left_out.h has
/// it. `find` makes masks where none are given. Throws Error when too many do, for a picture or
/// mask whose size is wrong, for masks that are all empty or look inverted, and what the loader
/// throws for masks; Cancelled when asked to stop.
PreparedViews prepare_views(Scene& scene, const ViewLoader& loader, const PrepareOptions& options,
                            Progress& progress, const MaskFinder& find = find_masks);

}  // namespace photohull
