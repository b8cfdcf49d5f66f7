// From a scene's files to views that are ready for carving: decoded, pinhole, with masks.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/file_mask.h"
#include "core/image.h"
#include "core/progress.h"
#include "core/scene.h"

namespace photohull {

/// How pixels are read; lets this module stay free of image formats. Both are called from several
/// threads at once and throw Error for files that cannot be read.
struct ViewLoader {
  std::function<ColourImage(const std::filesystem::path&)> image;
  std::function<FileMask(const std::filesystem::path&)> mask;
};

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
  /// the photograph does: wide-angle corners would otherwise stretch without end. In [1, 8].
  double max_frame_growth = 2.0;

  /// Throws UsageError for values outside their range.
  void validate() const;
};

/// A view's mask: where it came from and how sure it is, [0, 1]. Masks that were given are not
/// judged (1); 0 where there is none.
struct MaskJudgement {
  /// Below this a mask is named in a warning.
  static constexpr double kDoubtful = 0.6;

  std::string
      source;  ///< "mask files", "alpha channels", "background plate", "background model", "none"
  double confidence = 0;
};

/// Views in the scene's order. In every view:
///  - image alpha tells what is known: 1 for a photographed pixel, 0 where undistortion found no
///    source. `image.has_alpha` is set when such unknown pixels exist. The file's own alpha
///    channel, if any, has moved into the mask.
///  - mask coverage of unknown pixels is 255: what was not photographed must not be carved.
///  - without masks, `mask.empty()`.
struct PreparedViews {
  std::vector<View> views;
  std::string mask_source;  ///< "mask files", "alpha channels", "background model", "none", ...
  std::vector<MaskJudgement> masks;
  double mask_confidence = 0;  ///< [0, 1]: the least of the views' that have masks, 0 without masks
  std::vector<std::string> warnings;
};

/// Decodes in parallel (within the caller's task arena), checks sizes, finds masks and removes
/// lens distortion. Undistorted pictures keep the focal length in pixels at the principal point
/// and are resampled in linear light; views without distortion keep their bytes as decoded.
/// Views whose pictures cannot be decoded leave the scene, with a warning, as core/left_out.h has
/// it. Throws Error when too many do, for a picture or mask whose size is wrong, for masks that are
/// all empty or look inverted, and what the loader throws for masks; Cancelled when asked to stop.
PreparedViews prepare_views(Scene& scene, const ViewLoader& loader, const PrepareOptions& options,
                            Progress& progress);

}  // namespace photohull
