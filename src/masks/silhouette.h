// Distance to the silhouette of a mask.
#pragma once

#include <glm/glm.hpp>

#include "core/image.h"
#include "core/silhouette.h"

namespace photohull {

/// Only what the frame shows counts: a contour is never closed along the frame. A mask without
/// foreground gives +kNoContour everywhere, one without background -kNoContour.
///
/// Close to the contour the error is a few hundredths of a pixel for anti-aliased masks (coverage
/// is taken as the area that the object covers). `mask` must not be empty.
SilhouetteDistance silhouette_distance(const Mask& mask);

/// Of a mask whose coverage is the chance that the object is there: weighs each distance outside
/// the outline by how sure the mask is of its background there, from 0 at an even chance to 1.
void weigh_by_certainty(const Mask& mask, SilhouetteDistance& distance);

/// The distance at a pixel position, bilinear; beyond the frame it goes on as at its border.
double interpolated(const SilhouetteDistance& distance, const glm::dvec2& pixel);

}  // namespace photohull
