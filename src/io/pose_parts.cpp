#include "io/pose_parts.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "core/error.h"
#include "io/camera_checks.h"

namespace photohull::io {

glm::dmat3 from_rows(std::span<const double, 9> e) {
  return glm::transpose(glm::dmat3(e[0], e[1], e[2], e[3], e[4], e[5], e[6], e[7], e[8]));
}

Pose pose_at(const glm::dmat3& rotation, const glm::dvec3& center) {
  return {rotation, -(rotation * center)};
}

glm::dmat3 rotation_of(std::span<const double, 4> wxyz, const std::string& where) {
  const glm::dquat q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  if (!(std::abs(glm::length(q) - 1.0) <= 1e-3))
    throw Error(concat(where, ": the quaternion has length ", glm::length(q),
                       ", but a rotation needs length 1"));
  return glm::mat3_cast(glm::normalize(q));
}

glm::dmat3 turned_about_x(const glm::dmat3& rotation) {
  return glm::dmat3(1, 0, 0, 0, -1, 0, 0, 0, -1) * rotation;
}

glm::dvec3 turned_about_x(const glm::dvec3& t) { return {t.x, -t.y, -t.z}; }

Intrinsics intrinsics_of(std::span<const double, 9> v, const std::string& where) {
  const double largest = std::abs(v[0]) + std::abs(v[4]) + std::abs(v[8]);
  if (v[8] == 0 || v[0] == 0 || v[4] == 0)
    throw Error(concat(where, ": K is singular (k11 ", v[0], ", k22 ", v[4], ", k33 ", v[8],
                       "); none of them may be 0"));
  if (std::abs(v[3]) + std::abs(v[6]) + std::abs(v[7]) > 1e-9 * largest)
    throw Error(concat(where, ": K is not upper triangular (k21 ", v[3], ", k31 ", v[6], ", k32 ",
                       v[7], "); all three must be 0"));
  Intrinsics k;
  k.fx = v[0] / v[8];
  k.skew = v[1] / v[8];
  k.cx = v[2] / v[8];
  k.fy = v[4] / v[8];
  k.cy = v[5] / v[8];
  return k;
}

Camera camera_of_projection(std::span<const double, 12> p, const std::string& where) {
  double largest = 0;
  for (const double value : p) {
    if (!std::isfinite(value)) throw Error(where + ": a value is not a finite number");
    largest = std::max(largest, std::abs(value));
  }
  // Rows of the left 3x3 part, its third one of length 1 so that it is the optical axis.
  glm::dvec3 a(p[0], p[1], p[2]), b(p[4], p[5], p[6]), c(p[8], p[9], p[10]), d(p[3], p[7], p[11]);
  const double length = glm::length(c);
  const double determinant = glm::dot(glm::cross(a, b), c);
  const double volume = glm::length(a) * glm::length(b) * length;
  if (!(length > 1e-12 * largest) || !(std::abs(determinant) > 1e-9 * volume))
    throw Error(where +
                ": the projection matrix is singular: its left 3x3 part cannot be inverted");
  const double scale = (determinant < 0 ? -1 : 1) / length;
  a *= scale, b *= scale, c *= scale, d *= scale;
  // RQ decomposition by Gram and Schmidt from the last row upwards.
  Camera camera;
  Intrinsics& k = camera.intrinsics;
  k.cx = glm::dot(a, c);
  k.cy = glm::dot(b, c);
  const glm::dvec3 b_rest = b - k.cy * c;
  k.fy = glm::length(b_rest);
  const glm::dvec3 y = b_rest / k.fy;
  k.skew = glm::dot(a, y);
  const glm::dvec3 a_rest = a - k.cx * c - k.skew * y;
  k.fx = glm::length(a_rest);
  const glm::dmat3 rotation = glm::transpose(glm::dmat3(a_rest / k.fx, y, c));
  camera.cam_from_world.rotation = checked_rotation(rotation, where, "the projection matrix's R");
  const double ty = (d.y - k.cy * d.z) / k.fy;
  camera.cam_from_world.translation = {(d.x - k.cx * d.z - k.skew * ty) / k.fx, ty, d.z};
  return camera;
}

std::array<double, 12> projection_rows(const Camera& camera, double pixel_center) {
  Camera shifted = camera;
  shifted.intrinsics.cx += pixel_center;
  shifted.intrinsics.cy += pixel_center;
  const glm::dmat4x3 p = shifted.projection();
  std::array<double, 12> rows;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column) rows[4 * row + column] = p[column][row];
  return rows;
}

}  // namespace photohull::io
