// How noisy a photograph is.
#pragma once

#include "core/image.h"

namespace photohull {

/// Noise that rounding to 8-bit codes alone leaves, a standard deviation of full scale: 1 /
/// sqrt(12) of a code.
inline constexpr double kRoundingNoise = 0.28867513459481287 / 255;

/// Standard deviation of the noise of the image's luminance, in units of square-root-encoded
/// linear light (full scale 1; the square root makes photon noise about the same at all
/// brightnesses). From the flattest fifth of a sample of well exposed blocks; 0 where there are
/// none. Costs about 1 ms, whatever the image's size.
double estimate_image_noise(const ColourImage& image);

}  // namespace photohull
