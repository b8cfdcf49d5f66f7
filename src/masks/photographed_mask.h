// Masks without what lies beside the photograph.
#pragma once

#include "core/image.h"

namespace photohull {

/// Undistorted photographs have strips at their frame that nothing was photographed in, and masks
/// are 255 there, so that nothing is carved by them. They are no part of the object's outline, and
/// no thin parts: this gives 0 to those that are farther than 64 pixels from foreground that was
/// photographed. Nearer ones stay, since the object goes on there. Both have the same size.
Mask photographed_mask(const ColourImage& image, const Mask& mask);

}  // namespace photohull
