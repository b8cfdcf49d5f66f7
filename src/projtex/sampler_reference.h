// Double-precision references of the samplers (shaders/include/sample_*.glsl), written on their own
// from the definitions, and the oracle that they are measured against.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/image.h"
#include "projtex/gpu_views.h"
#include "projtex/project_layer_reference.h"
#include "projtex/sampler.h"

namespace photohull::projtex::reference {

/// An image as the samplers see it: linear light times coverage, and coverage (alpha times mask),
/// in the top-left of `array_size` pixels (multiples of kPadding); nothing elsewhere.
LinearImage covered_image(const ColourImage& image, const Mask& mask, const glm::ivec2& array_size);

/// All levels of a covered image: means of 2 x 2 pixels, kSampleLevels of them.
std::vector<LinearImage> covered_chain(LinearImage image);

/// A square on a plane as a camera sees it: where its centre falls, and how the position moves
/// along its edges (the columns of the Jacobian of (s/q, t/q), exact at the centre), in pixels.
struct Footprint {
  bool in_front = false;  ///< q > 0; else nothing else counts
  glm::dvec2 pixel{0.0};
  glm::dvec2 du{0.0}, dv{0.0};
};

Footprint footprint_of(const GridCamera& camera, const PlaneSquare& square);

/// Singular values of the Jacobian (du dv), the greater first, and the direction of the greater.
struct FootprintAxes {
  double longer = 0, shorter = 0;
  glm::dvec2 direction{1, 0};
};
FootprintAxes axes_of(const Footprint& footprint);

/// What a sampler makes of one footprint on a covered chain: linear light times coverage, coverage.
/// Not for Sampler::kHardware, whose filter is the device's own.
glm::dvec4 sample_footprint(Sampler sampler, std::span<const LinearImage> chain,
                            const Footprint& footprint);

/// n x n footprints over the square, their mean; those behind the camera count as nothing.
glm::dvec4 sample_square(Sampler sampler, std::span<const LinearImage> chain,
                         const GridCamera& camera, const PlaneSquare& square, int supersample);

/// Square roots of the linear colour without its coverage, and the coverage; black where there is
/// none.
glm::dvec4 resolved(const glm::dvec4& covered);

/// Integral of the image, each pixel a square of even colour, over a convex polygon in pixel
/// positions, divided by the polygon's area. A polygon without area gives the pixel that its first
/// corner is in.
glm::dvec4 integrate_polygon(const LinearImage& image, std::span<const glm::dvec2> corners);

/// The oracle: integrate_polygon over the square's projection. Nothing unless all of the square is
/// in front of the camera.
glm::dvec4 oracle(const LinearImage& image, const GridCamera& camera, const PlaneSquare& square);

}  // namespace photohull::projtex::reference
