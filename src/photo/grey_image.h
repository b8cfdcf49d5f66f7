// Brightness of a photograph, for matching.
#pragma once

#include "core/image.h"
#include "photo/align_patch.h"

namespace photohull {

/// Brightness in 8-bit levels (sRGB-encoded, Rec. 601 weights).
GreyImage grey_image(const ColourImage& image);

/// Blurred by a Gaussian of 0.7 pixels: bilinear interpolation errs less on smooth images.
GreyImage smoothed(GreyImage image);

}  // namespace photohull
