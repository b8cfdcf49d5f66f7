// What lens, sensor and camera do to a photograph.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "synth/render.h"

namespace photohull::synth {

/// From linear light to the 8-bit sRGB picture (3 bytes a pixel) that the camera stores, in the
/// order of a real one: vignetting, blur, motion blur, exposure and white balance, noise, clipping,
/// sRGB, JPEG. Vignetting takes a share v r^2 of the light, r = 1 in the corners; the variance of
/// the noise is read^2 + photon^2 * light; code_noise is added to the sRGB codes. `view` and the
/// seed decide what differs between views; another `take` is the same view with other noise.
std::vector<std::uint8_t> expose(const Picture& picture, const DegradationSpec& spec,
                                 std::uint64_t seed, std::size_t view, std::uint64_t take = 0);

/// The same at 16 bits a channel, without JPEG.
std::vector<std::uint16_t> expose_16_bits(const Picture& picture, const DegradationSpec& spec,
                                          std::uint64_t seed, std::size_t view,
                                          std::uint64_t take = 0);

/// The factors of red, green and blue light by which exposure and white balance of a view differ.
glm::vec3 view_gain(const DegradationSpec& spec, std::uint64_t seed, std::size_t view);

/// Convolves with a Gaussian of deviation `sigma` pixels; beyond the border its pixels repeat.
void blur(std::vector<glm::vec3>& image, int width, int height, double sigma);

/// Blurs the more the farther from the middle: with a deviation of `sigma` pixels in the corners,
/// which grows with the distance squared.
void blur_edges(std::vector<glm::vec3>& image, int width, int height, double sigma);

/// Whether the camera moved while it took the view: the share motion_blur_views of all, evenly over
/// their order.
bool is_motion_blurred(const DegradationSpec& spec, std::size_t view);

/// The mean along a line of `length` pixels through each pixel, at `angle` (radians); beyond the
/// border its pixels repeat.
void motion_blur(std::vector<glm::vec3>& image, int width, int height, double length, double angle);

/// Encodes as baseline JPEG of quality 1 to 100 and decodes again.
std::vector<std::uint8_t> through_jpeg(std::span<const std::uint8_t> rgb, int width, int height,
                                       int quality);

}  // namespace photohull::synth
