// From pictures with lens distortion to ideal pinhole pictures.
#pragma once

#include <optional>

#include "core/camera.h"
#include "core/prepared_view.h"

namespace photohull {

/// Where a lens images the ray (x, y, 1): both in the image plane at z = 1 of the camera frame.
/// Formulas and order of coefficients are those of OpenCV's calib3d and its fisheye module.
glm::dvec2 distort(const Distortion& distortion, const glm::dvec2& ideal);

/// The ray (x, y, 1) that a lens images at `distorted`, by Newton's method; nothing where there is
/// none or the model folds.
std::optional<glm::dvec2> undistort_point(const Distortion& distortion,
                                          const glm::dvec2& distorted);

/// Pinhole intrinsics for the undistorted picture: the same focal lengths and skew, the principal
/// point moved by whole pixels, and the smallest frame that shows all of the photograph within
/// `max_growth` times the photograph's extent from the principal point to each side.
Intrinsics undistorted_intrinsics(const Intrinsics& source, const Distortion& distortion,
                                  double max_growth);

/// Those that undistort() gives a view: without distortion the source's.
Intrinsics pinhole_intrinsics(const Intrinsics& source, const Distortion& distortion,
                              double max_growth);

/// Resamples the image (bicubic, in linear light) and its mask (bilinear) to
/// undistorted_intrinsics() and sets view.camera to them. Pixels that the photograph does not
/// show get alpha 0 and coverage 255: they are unknown. Without distortion nothing happens.
void undistort(const Distortion& distortion, double max_growth, PreparedView& view);

/// The same, to a camera that every format can express: no distortion, no skew, square pixels of
/// the finer of the two focal lengths, the principal point in the middle of the frame.
void rectify(const Distortion& distortion, double max_growth, PreparedView& view);

}  // namespace photohull
