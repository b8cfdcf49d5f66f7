#include "core/camera.h"

namespace photohull {

glm::dmat3 Intrinsics::k() const { return {{fx, 0.0, 0.0}, {skew, fy, 0.0}, {cx, cy, 1.0}}; }

glm::dvec3 Camera::center() const {
  return -(glm::transpose(cam_from_world.rotation) * cam_from_world.translation);
}

glm::dvec3 Camera::forward() const {
  return glm::transpose(cam_from_world.rotation) * glm::dvec3(0, 0, 1);
}

glm::dvec3 Camera::to_camera(const glm::dvec3& world) const {
  return cam_from_world.rotation * world + cam_from_world.translation;
}

std::optional<glm::dvec2> Camera::project(const glm::dvec3& world) const {
  const glm::dvec3 p = intrinsics.k() * to_camera(world);
  if (!(p.z > 0)) return std::nullopt;
  return glm::dvec2(p) / p.z;
}

glm::dvec3 Camera::ray(const glm::dvec2& pixel) const {
  const double y = (pixel.y - intrinsics.cy) / intrinsics.fy;
  const double x = (pixel.x - intrinsics.cx - intrinsics.skew * y) / intrinsics.fx;
  return glm::normalize(glm::transpose(cam_from_world.rotation) * glm::dvec3(x, y, 1.0));
}

bool Camera::on_image(const glm::dvec2& pixel) const {
  return pixel.x >= -0.5 && pixel.y >= -0.5 && pixel.x <= intrinsics.width - 0.5 &&
         pixel.y <= intrinsics.height - 0.5;
}

glm::dmat4x3 Camera::projection() const {
  const glm::dmat3& r = cam_from_world.rotation;
  return intrinsics.k() * glm::dmat4x3(r[0], r[1], r[2], cam_from_world.translation);
}

}  // namespace photohull
