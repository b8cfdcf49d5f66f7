// Holes and bites in a mask where the photograph shows the object.
#pragma once

#include "core/image.h"

namespace photohull {

/// What was put back into a mask.
struct MendedMask {
  int holes = 0;     ///< regions: holes and bites
  double share = 0;  ///< of the mask's area before
};

/// Puts back what a mask leaves out of the object though the photograph shows it: regions that lie
/// within the mask (holes of any size, and bites up to a tenth of the image's longer side wide) and
/// whose colours are the object's, not the background's, by histograms of both in this image, and
/// which no edge parts from the object. Where object and background look alike nothing is judged,
/// and the mask stays. Real openings show the background, and stay. `image` and `mask` are of one
/// size; a mask without area stays as it is.
MendedMask mend_mask(const ColourImage& image, Mask& mask);

}  // namespace photohull
