// Photographs for the eye.
#pragma once

#include "core/image.h"
#include "core/rgb_image.h"

namespace photohull::render {

/// sRGB byte of a linear value, clamped.
std::uint8_t encode_srgb(float linear);
/// Linear value of an sRGB byte.
float decode_srgb(std::uint8_t byte);

/// A rectangle of a photograph, its top-left corner at pixel area corner (x, y), at `scale` output
/// pixels a pixel: means over pixel areas when smaller, bilinear when larger. What lies outside the
/// photograph repeats its border.
RgbImage cut_photograph(const ColourImage& image, double x, double y, double scale, int width,
                        int height);

}  // namespace photohull::render
