#include "cameras/triangulate.h"

#include <cmath>
#include <limits>

namespace photohull {
namespace {

/// The point nearest to all rays; nothing when they are as good as parallel.
std::optional<glm::dvec3> nearest_to_rays(std::span<const Camera> cameras, const Track& track) {
  glm::dmat3 normal(0.0);
  glm::dvec3 right(0.0);
  for (const Observation& o : track.observations) {
    const glm::dvec3 d = cameras[o.view].ray(o.pixel);
    const glm::dmat3 across = glm::dmat3(1.0) - glm::outerProduct(d, d);
    normal += across;
    right += across * cameras[o.view].center();
  }
  // For two rays the smallest eigenvalue is about half of the squared angle between them.
  const double n = double(track.observations.size());
  if (!(glm::determinant(normal) > 2.5e-7 * n * n * n)) return std::nullopt;
  return glm::inverse(normal) * right;
}

}  // namespace

std::optional<glm::dvec3> triangulate(std::span<const Camera> cameras, const Track& track) {
  std::optional<glm::dvec3> point = nearest_to_rays(cameras, track);
  for (int step = 0; point && step < 5; ++step) {
    glm::dmat3 normal(0.0);
    glm::dvec3 gradient(0.0);
    for (const Observation& o : track.observations) {
      const Camera& camera = cameras[o.view];
      const glm::dvec3 p = camera.to_camera(*point);
      if (!(p.z > 0)) return std::nullopt;
      const Intrinsics& k = camera.intrinsics;
      const glm::dvec3 du(k.fx / p.z, k.skew / p.z, -(k.fx * p.x + k.skew * p.y) / (p.z * p.z));
      const glm::dvec3 dv(0, k.fy / p.z, -k.fy * p.y / (p.z * p.z));
      const glm::dvec2 residual = *camera.project(*point) - o.pixel;
      for (const auto& [derivative, r] : {std::pair(du, residual.x), std::pair(dv, residual.y)}) {
        const glm::dvec3 j = derivative * camera.cam_from_world.rotation;
        normal += glm::outerProduct(j, j);
        gradient += r * j;
      }
    }
    *point -= glm::inverse(normal) * gradient;
  }
  if (!point || !(glm::length(*point) < std::numeric_limits<double>::infinity()))
    return std::nullopt;
  for (const Observation& o : track.observations)
    if (!cameras[o.view].project(*point)) return std::nullopt;
  return point;
}

double reprojection_rms(std::span<const Camera> cameras, const Track& track,
                        const glm::dvec3& point) {
  double sum = 0;
  for (const Observation& o : track.observations) {
    const auto pixel = cameras[o.view].project(point);
    if (!pixel) return std::numeric_limits<double>::infinity();
    sum += glm::dot(*pixel - o.pixel, *pixel - o.pixel);
  }
  return std::sqrt(sum / double(track.observations.size()));
}

}  // namespace photohull
