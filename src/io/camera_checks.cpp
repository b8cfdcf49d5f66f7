#include "io/camera_checks.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace photohull::io {
namespace {

constexpr double kRotationTolerance = 1e-3;

/// Largest element of M^T M / scale^2 - I.
double deviation(const glm::dmat3& m, double scale) {
  const glm::dmat3 gram = glm::transpose(m) * m;
  double worst = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      worst = std::max(worst, std::abs(gram[i][j] / (scale * scale) - (i == j ? 1.0 : 0.0)));
  return worst;
}

bool all_finite(const glm::dmat3& m) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!std::isfinite(m[i][j])) return false;
  return true;
}

/// Rotation factor of the polar decomposition by Newton's iteration (Higham 1986), which converges
/// quadratically: from 1e-3 three steps reach rounding.
glm::dmat3 nearest_rotation(glm::dmat3 m) {
  for (int step = 0; step < 4; ++step) m = 0.5 * (m + glm::inverse(glm::transpose(m)));
  return m;
}

}  // namespace

glm::dmat3 checked_rotation(const glm::dmat3& matrix, const std::string& where,
                            std::string_view field) {
  const std::string prefix = concat(where, ": ", field, " ");
  if (!all_finite(matrix)) throw Error(prefix + "holds a value that is not a finite number");
  const glm::dmat3 gram = glm::transpose(matrix) * matrix;
  const double scale = std::sqrt((gram[0][0] + gram[1][1] + gram[2][2]) / 3.0);
  if (!(scale > 0) || !std::isfinite(scale) || !(deviation(matrix, scale) <= kRotationTolerance))
    throw Error(prefix + concat("is not a rotation (its axes are off orthonormal by ",
                                scale > 0 ? deviation(matrix, scale) : 1.0,
                                "); write it with more digits or check the order of its values"));
  if (!(deviation(matrix, 1.0) <= kRotationTolerance))
    throw Error(prefix +
                concat("holds a uniform scale of ", scale, "; divide its rotation part by that"));
  if (glm::determinant(matrix) < 0)
    throw Error(prefix + "has determinant -1, a mirroring; check the signs of its axes");
  return nearest_rotation(matrix);
}

void check_camera(const Camera& camera, const Distortion& distortion, const std::string& where) {
  const Intrinsics& k = camera.intrinsics;
  if (k.width <= 0 || k.height <= 0)
    throw Error(concat(where, ": the image size is ", k.width, " x ", k.height,
                       ", but both must be positive"));
  for (const double focal : {k.fx, k.fy})
    if (!std::isfinite(focal) || !(focal > 0))
      throw Error(concat(where, ": the focal length is ", focal,
                         " pixels, but it must be positive and finite"));
  for (const double value : {k.cx, k.cy, k.skew})
    if (!std::isfinite(value))
      throw Error(concat(where, ": the principal point or skew is ", value, ", not finite"));
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(camera.cam_from_world.translation[axis]))
      throw Error(concat(where, ": the camera's position is not finite"));
  for (const double coefficient : distortion.coefficients)
    if (!std::isfinite(coefficient))
      throw Error(concat(where, ": a distortion coefficient is ", coefficient, ", not finite"));
}

}  // namespace photohull::io
