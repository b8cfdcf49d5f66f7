// Photographs made smaller.
#pragma once

#include "core/image.h"
#include "core/scene.h"

namespace photohull {

/// The camera of a photograph resampled to `width` x `height` pixels.
Camera resized(const Camera& camera, int width, int height);

/// Every pixel the mean of the area that it covers, of stored values: 8-bit sRGB or linear. The
/// size must not be larger than the image's.
ColourImage shrink(const ColourImage& image, int width, int height);
Mask shrink(const Mask& mask, int width, int height);

}  // namespace photohull
