// Pictures made smaller: which pixels they have, and what their cameras become.
//
// A picture of scale s has pixels of 1/s x 1/s pixels of the file, beginning at the file's
// top-left corner; those at the right and lower border cover what is left. So the centre of the
// file's pixel u lies at (u + 0.5) s - 0.5.
#pragma once

#include <glm/glm.hpp>

#include "core/camera.h"

namespace photohull {

/// Pixels of a side of `length` pixels at `scale`, in (0, 1]: as many as cover it, 1 at least.
int scaled_length(int length, double scale);

/// Where a position in the file's pixels lies in those of the scaled picture.
glm::dvec2 scaled_pixel(const glm::dvec2& pixel, double scale);

/// Intrinsics of the scaled picture. Lens distortion is one of rays and stays.
Intrinsics scaled_intrinsics(const Intrinsics& k, double scale);

}  // namespace photohull
