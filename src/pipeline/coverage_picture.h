// From which sides photographs were taken, as a picture.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/rgb_image.h"
#include "pipeline/coverage.h"

namespace photohull::pipeline {

/// A photograph that the scene does without.
struct LeftOutPhoto {
  std::string name;
  std::optional<SkyPlace> place;  ///< about where it was taken, if that is known
};

/// The sky seen from above: the azimuth is the angle, x to the right, and the elevation the radius,
/// with the zenith in the middle and the horizon as a circle. A dot for each photograph, hollow
/// where it does not count for gaps; a cross for each that was left out and has a place, and the
/// names of all that were; gaps shaded, with their degrees and the photographs beside them.
RgbImage draw_coverage(const Coverage& coverage, std::span<const LeftOutPhoto> left_out);

}  // namespace photohull::pipeline
