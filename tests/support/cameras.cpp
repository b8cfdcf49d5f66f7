#include "support/cameras.h"

#include <cmath>
#include <glm/gtc/constants.hpp>

namespace photohull::test {

double uniform(Rng& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}

glm::dvec3 uniform_in(Rng& rng, const Box& box) {
  const double x = uniform(rng, 0, 1), y = uniform(rng, 0, 1), z = uniform(rng, 0, 1);
  return box.min + box.size() * glm::dvec3(x, y, z);
}

glm::dvec3 random_direction(Rng& rng) {
  std::normal_distribution<double> normal;
  const double x = normal(rng), y = normal(rng), z = normal(rng);
  return glm::normalize(glm::dvec3(x, y, z));
}

Camera look_at(const glm::dvec3& eye, const glm::dvec3& target, double focal, int width, int height,
               const glm::dvec3& down) {
  const glm::dvec3 z = glm::normalize(target - eye);
  glm::dvec3 x = glm::cross(down, z);
  if (glm::length(x) < 1e-6) x = glm::cross(glm::dvec3(0, 1, 0), z);
  x = glm::normalize(x);
  Camera camera;
  camera.intrinsics = {width, height, focal, focal, 0, 0.5 * (width - 1), 0.5 * (height - 1)};
  camera.cam_from_world.rotation = glm::transpose(glm::dmat3(x, glm::cross(z, x), z));
  camera.cam_from_world.translation = -(camera.cam_from_world.rotation * eye);
  return camera;
}

Camera put_off(const Camera& camera, double pixels, int index) {
  const double angle = pixels / camera.intrinsics.fx, way = 8.5 + 3.9 * index;
  const glm::dvec3 turn = angle * glm::dvec3(std::cos(way), std::sin(way), std::cos(3 * way));
  // Rows of a small turn, made orthonormal.
  const glm::dvec3 x = glm::normalize(glm::dvec3(1, -turn.z, turn.y));
  const glm::dvec3 z = glm::normalize(glm::cross(x, glm::dvec3(turn.z, 1, -turn.x)));
  const glm::dmat3 turned = glm::transpose(glm::dmat3(x, glm::cross(z, x), z));
  Camera off = camera;
  off.cam_from_world.rotation = turned * camera.cam_from_world.rotation;
  off.cam_from_world.translation = turned * camera.cam_from_world.translation;
  return off;
}

Camera random_camera(Rng& rng, const Box& box, int width, int height) {
  const double distance = uniform(rng, 1, 3) * box.diagonal();
  const glm::dvec3 eye = box.center() + distance * random_direction(rng);
  const glm::dvec3 target =
      uniform_in(rng, {box.center() - 0.2 * box.size(), box.center() + 0.2 * box.size()});
  const double focal = uniform(rng, 0.8, 1.2) * std::min(width, height) * distance / box.diagonal();
  Camera camera = look_at(eye, target, focal, width, height, random_direction(rng));
  Intrinsics& k = camera.intrinsics;
  k.fy *= uniform(rng, 0.9, 1.1);
  k.skew = uniform(rng, -0.02, 0.02) * k.fx;
  k.cx += uniform(rng, -0.1, 0.1) * width;
  k.cy += uniform(rng, -0.1, 0.1) * height;
  return camera;
}

std::vector<Camera> cameras_around(const glm::dvec3& target, double distance, int count,
                                   double focal, int width, int height) {
  // Points of a Fibonacci lattice on the sphere.
  const double golden = glm::pi<double>() * (3.0 - std::sqrt(5.0));
  std::vector<Camera> cameras;
  for (int i = 0; i < count; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / count, r = std::sqrt(1.0 - z * z);
    const glm::dvec3 direction(r * std::cos(golden * i), r * std::sin(golden * i), z);
    cameras.push_back(look_at(target + distance * direction, target, focal, width, height));
  }
  return cameras;
}

}  // namespace photohull::test
