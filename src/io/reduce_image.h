// Pictures in memory made smaller, as read_image and read_mask make those of files.
#pragma once

#include <glm/glm.hpp>

#include "core/image.h"

namespace photohull::io {

/// At a scale in (0, 1] (core/image_scale.h): means in linear light, of alpha too.
ColourImage reduced(const ColourImage& image, double scale);

/// The mean of the coverage over each of the result's pixels, at a scale for x and one for y, both
/// above 0. An empty mask stays empty.
Mask reduced(const Mask& mask, const glm::dvec2& scale);

}  // namespace photohull::io
