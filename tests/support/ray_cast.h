// Photographs of analytic scenes.
#pragma once

#include <functional>

#include "core/camera.h"
#include "core/image.h"
#include "support/cameras.h"

namespace photohull::test {

/// Linear colour that a ray (unit direction) from `eye` meets.
using Tracer = std::function<glm::dvec3(const glm::dvec3& eye, const glm::dvec3& ray)>;

/// 8-bit sRGB image, n x n rays a pixel averaged in linear light.
ColourImage ray_cast(const Camera& camera, const Tracer& tracer, int n = 3);

/// An image of independent random pixels, each channel of the encoded value in [low, high] of 255.
ColourImage random_image(Rng& rng, int width, int height, int low = 0, int high = 255);

/// The same pixels in linear half floats.
ColourImage to_half(const ColourImage& image);

/// Smooth noise on 3-space in [0, 1] whose details are about `scale` large.
double solid_noise(const glm::dvec3& p, double scale);

/// A colour built of solid_noise at two scales; it has texture on every plane.
glm::dvec3 noise_colour(const glm::dvec3& p, double scale);

}  // namespace photohull::test
