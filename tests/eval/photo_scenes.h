// Photographed surfaces with known answers, for the tests of agreement with photographs.
#pragma once

#include <cmath>
#include <vector>

#include "core/prepared_view.h"
#include "support/cameras.h"
#include "support/ray_cast.h"
#include "support/silhouettes.h"

namespace photohull::test {

inline constexpr double kSphereRadius = 1;

/// Textured sphere of kSphereRadius around the world's origin before a plain wall.
inline glm::dvec3 trace_sphere(const glm::dvec3& eye, const glm::dvec3& ray) {
  const double along = -glm::dot(eye, ray);
  const double off = glm::length(eye + along * ray);
  if (off >= kSphereRadius) return {0.02, 0.02, 0.05};
  const double depth = along - std::sqrt(kSphereRadius * kSphereRadius - off * off);
  return 0.05 + 0.8 * noise_colour(eye + depth * ray, 0.15);
}

/// The plane z = 0, textured.
inline glm::dvec3 trace_plane(const glm::dvec3& eye, const glm::dvec3& ray) {
  return 0.05 + 0.8 * noise_colour(eye - eye.z / ray.z * ray, 0.15);
}

inline PreparedView photograph(const Camera& camera, const Tracer& tracer) {
  PreparedView view;
  view.camera = camera;
  view.image = ray_cast(camera, tracer, 3);
  return view;
}

/// `count` views on a ring around the sphere, 12 degrees apart, with masks.
inline std::vector<PreparedView> sphere_views(int count) {
  std::vector<PreparedView> views;
  for (int i = 0; i < count; ++i) {
    const double a = 12 * M_PI / 180 * i;
    const Camera camera =
        look_at({6 * std::cos(a), 6 * std::sin(a), 1.5}, glm::dvec3(0), 260, 120, 110);
    views.push_back(photograph(camera, trace_sphere));
    views.back().mask = sphere_outline(camera, glm::dvec3(0), kSphereRadius).mask;
    views.back().name = "ring" + std::to_string(i);
  }
  return views;
}

/// Views of the plane from height 4 in a row, 15 degrees apart around the one in the middle.
inline std::vector<PreparedView> plane_views(int count, const Tracer& tracer = trace_plane) {
  std::vector<PreparedView> views;
  for (int i = 0; i < count; ++i) {
    const double a = 15 * M_PI / 180 * (i - count / 2);
    views.push_back(photograph(
        look_at({4 * std::sin(a), 0, 4 * std::cos(a)}, glm::dvec3(0), 160, 96, 80, {0, -1, 0}),
        tracer));
    views.back().name = "row" + std::to_string(i);
  }
  return views;
}

}  // namespace photohull::test
