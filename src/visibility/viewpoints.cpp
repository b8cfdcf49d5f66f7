#include "visibility/viewpoints.h"

#include <algorithm>
#include <cmath>

namespace photohull::visibility {
namespace {

using glm::dvec3;

constexpr double kOverlap = 4;  ///< texels that kernels may need beyond 90 degrees

Camera looking(const dvec3& eye, const dvec3& forward, int width, int height, double focal) {
  Camera c;
  const dvec3 down = std::abs(forward.z) > 0.999 ? dvec3(0, 1, 0) : dvec3(0, 0, -1);
  const dvec3 x = glm::normalize(glm::cross(down, forward)), y = glm::cross(forward, x);
  c.cam_from_world.rotation = glm::transpose(glm::dmat3(x, y, forward));
  c.cam_from_world.translation = -(c.cam_from_world.rotation * eye);
  c.intrinsics = {width, height, focal, focal, 0, 0.5 * (width - 1), 0.5 * (height - 1)};
  return c;
}

}  // namespace

Camera frame_sphere(const dvec3& eye, const dvec3& target, double radius, int width, int height) {
  const double distance = glm::length(target - eye), sine = std::min(radius / distance, 0.9);
  const double focal = 0.5 * std::min(width, height) * std::sqrt(1 - sine * sine) / sine;
  return looking(eye, glm::normalize(target - eye), width, height, focal);
}

std::vector<Camera> look_around(const dvec3& eye, int texels) {
  std::vector<Camera> out;
  const double focal = std::max(0.5 * texels - kOverlap, 0.25 * texels);
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      dvec3 forward(0.0);
      forward[axis] = side;
      out.push_back(looking(eye, forward, texels, texels, focal));
    }
  return out;
}

}  // namespace photohull::visibility
