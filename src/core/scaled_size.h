// Copies of a photograph that were made larger or smaller, and the cameras that they have.
#pragma once

#include "core/camera.h"

namespace photohull {

/// Can an image of width x height pixels be the whole of one of from_width x from_height, scaled by
/// one factor in both directions? Sides may be rounded to the nearest pixel, both down or both up.
/// False for equal sizes, and where no side differs by two pixels: that can as well be a border
/// that was cut off.
bool is_scaled_copy(int width, int height, int from_width, int from_height);

/// Intrinsics of the copy: the areas of both images are the same part of the image plane, so with
/// f = width / k.width (and alike for y) fx' = f fx, skew' = f skew, cx' = f (cx + 1/2) - 1/2.
/// Distortion stays as it is: all DistortionModels are of the image plane at z = 1. `k` has a size.
Intrinsics scaled_to(const Intrinsics& k, int width, int height);

/// Where a pixel position of an image of k's size is in the copy.
glm::dvec2 scaled_to(const glm::dvec2& pixel, const Intrinsics& k, int width, int height);

}  // namespace photohull
