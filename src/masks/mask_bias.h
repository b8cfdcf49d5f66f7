// Masks that are all a little too small or too large, measured on the photographs.
#pragma once

#include <span>

#include "core/image.h"
#include "core/prepared_view.h"
#include "core/silhouette.h"

namespace photohull {

/// Where the photographs have the object's outline, beside where the masks have it.
struct MaskBias {
  double pixels = 0;     ///< outward: positive where the masks are too small
  double contrast = 0;   ///< of the edge there to what lies around it; 0: nothing could be measured
  double agreement = 0;  ///< share of the views that have their strongest edge there, [0, 1]

  /// Is it certain enough, and large enough, to follow?
  bool counts() const;
};

/// The mean slope of brightness across the masks' contours, as a function of the distance from
/// them: texture on both sides averages out, the outline stands out. Distances to 16 pixels (or 2 %
/// of the image's longer side) on both sides are tried. Where the photographs' strongest slope lies
/// is compared with where the masks' own coverage has it, for parts narrower than two pixels have
/// it beside their outline. `silhouettes` are those of the views' masks, null for views without.
MaskBias measure_mask_bias(std::span<const PreparedView> views,
                           std::span<const SilhouetteDistance* const> silhouettes);

/// Moves the contour outward by `pixels` (inward where negative), in the mask and its distances.
void move_outline(double pixels, Mask& mask, SilhouetteDistance& silhouette);

}  // namespace photohull
