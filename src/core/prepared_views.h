// Views that are ready for carving, and what is known of their masks.
#pragma once

#include <string>
#include <vector>

#include "core/prepared_view.h"

namespace photohull {

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
  std::vector<PreparedView> views;
  std::string mask_source;  ///< "mask files", "alpha channels", "background model", "none", ...
  std::vector<MaskJudgement> masks;
  double mask_confidence = 0;  ///< [0, 1]: the least of the views' that have masks, 0 without masks
  std::vector<std::string> warnings;
};

}  // namespace photohull
