#include "support/silhouettes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

namespace photohull::test {
namespace {

double distance_to_segment(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
  const glm::dvec2 ab = b - a;
  const double t = std::clamp(glm::dot(p - a, ab) / std::max(glm::dot(ab, ab), 1e-30), 0.0, 1.0);
  return glm::length(p - a - t * ab);
}

/// The circle in which the cone from `eye` touches the sphere.
std::vector<glm::dvec3> horizon(const glm::dvec3& eye, const glm::dvec3& centre, double radius) {
  constexpr int kPoints = 180;
  const glm::dvec3 axis = eye - centre;
  const double distance = glm::length(axis), along = radius * radius / distance;
  const double across = radius * std::sqrt(1.0 - radius * radius / (distance * distance));
  const glm::dvec3 z = axis / distance;
  const glm::dvec3 other = std::abs(z.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(other, z)), y = glm::cross(z, x);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2.0 * glm::pi<double>() * i / kPoints;
    points.push_back(centre + along * z + across * (std::cos(angle) * x + std::sin(angle) * y));
  }
  return points;
}

bool ray_hits_sphere(const glm::dvec3& eye, const glm::dvec3& ray, const glm::dvec3& centre,
                     double radius) {
  const double along = glm::dot(centre - eye, ray);
  return along > 0 && glm::length(eye + along * ray - centre) < radius;
}

}  // namespace

Outline rasterise(int width, int height, const Shape& shape) {
  Outline out{{width, height, {}}, {width, height, {}}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double d = shape({x, y});
      out.distance.pixels.push_back(float(d));
      out.mask.coverage.push_back(std::uint8_t(std::lround(255 * std::clamp(0.5 - d, 0.0, 1.0))));
    }
  return out;
}

Outline random_outline(Rng& rng, int width, int height) {
  struct Disc {
    glm::dvec2 centre;
    double radius;
  };
  std::vector<Disc> discs;
  for (int i = 0; i < 4; ++i) {
    const double y = uniform(rng, 0.1, 0.9) * height, x = uniform(rng, 0.1, 0.9) * width;
    const glm::dvec2 centre(x, y);
    discs.push_back({centre, uniform(rng, 0.2, 0.45) * std::min(width, height)});
  }
  return rasterise(width, height, [&](const glm::dvec2& pixel) {
    double d = 1e4;
    for (const Disc& disc : discs) d = std::min(d, glm::length(pixel - disc.centre) - disc.radius);
    return d;
  });
}

Outline sphere_outline(const Camera& camera, const glm::dvec3& centre, double radius) {
  std::vector<glm::dvec2> contour;
  for (const glm::dvec3& p : horizon(camera.center(), centre, radius))
    contour.push_back(camera.project(p).value());
  return rasterise(camera.intrinsics.width, camera.intrinsics.height, [&](const glm::dvec2& pixel) {
    double d = 1e9;
    for (std::size_t i = 0; i < contour.size(); ++i)
      d = std::min(d, distance_to_segment(pixel, contour[i], contour[(i + 1) % contour.size()]));
    return ray_hits_sphere(camera.center(), camera.ray(pixel), centre, radius) ? -d : d;
  });
}

Outline wire_outline(const Camera& camera, const glm::dvec3& a, const glm::dvec3& b,
                     double radius) {
  const glm::dvec2 pa = camera.project(a).value(), pb = camera.project(b).value();
  const double depth = camera.to_camera(0.5 * (a + b)).z;
  const double radius_px = radius * camera.intrinsics.fx / depth;
  return rasterise(camera.intrinsics.width, camera.intrinsics.height,
                   [&](const glm::dvec2& p) { return distance_to_segment(p, pa, pb) - radius_px; });
}

}  // namespace photohull::test
