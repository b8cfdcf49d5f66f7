// Thin rods: masks exactly as cameras see them, and tubes around them.
#pragma once

#include <numbers>
#include <vector>

#include "core/mesh.h"
#include "masks/drawn_masks.h"
#include "support/cameras.h"

namespace photohull::test {

/// A round rod along a line of points. World units.
struct Rod {
  std::vector<glm::dvec3> axis;
  double radius = 0;

  glm::dvec3 direction(std::size_t i) const {
    return glm::normalize(axis[std::min(i + 1, axis.size() - 1)] - axis[i == 0 ? 0 : i - 1]);
  }
  double distance(const glm::dvec3& p) const {
    double least = 1e300;
    for (std::size_t i = 0; i + 1 < axis.size(); ++i) {
      const glm::dvec3 ab = axis[i + 1] - axis[i];
      const double t = std::clamp(glm::dot(p - axis[i], ab) / glm::dot(ab, ab), 0.0, 1.0);
      least = std::min(least, glm::distance(p, axis[i] + t * ab));
    }
    return least;
  }
};

inline Rod straight_rod(const glm::dvec3& a, const glm::dvec3& b, double radius, int pieces = 1) {
  Rod rod{{}, radius};
  for (int i = 0; i <= pieces; ++i) rod.axis.push_back(glm::mix(a, b, double(i) / pieces));
  return rod;
}

/// Draws what the camera sees of the rod, whose radius is small beside its distance.
inline void draw(const Rod& rod, const Camera& camera, Drawing& drawing) {
  std::vector<glm::dvec2> one, other;
  for (std::size_t i = 0; i < rod.axis.size(); ++i) {
    const glm::dvec3 p = rod.axis[i], view = p - camera.center();
    const glm::dvec3 side = rod.radius * glm::normalize(glm::cross(rod.direction(i), view));
    one.push_back(camera.project(p + side).value());
    other.push_back(camera.project(p - side).value());
  }
  for (std::size_t i = 0; i + 1 < one.size(); ++i)
    drawing.add({one[i], one[i + 1], other[i + 1], other[i]});
}

/// A tube of `around` vertices about each point of the axis, moved by `off`.
inline void add_tube(const Rod& rod, double radius, const glm::dvec3& off, TriMesh& mesh,
                     int around = 8) {
  const auto first = std::uint32_t(mesh.positions.size());
  const int rings = int(rod.axis.size());
  for (int i = 0; i < rings; ++i) {
    const glm::dvec3 along = rod.direction(std::size_t(i));
    const glm::dvec3 x = glm::normalize(glm::cross(along, glm::dvec3(0.2, 0.3, 1))),
                     y = glm::cross(along, x);
    for (int j = 0; j < around; ++j) {
      const double angle = 2 * std::numbers::pi * j / around;
      const glm::dvec3 n = std::cos(angle) * x + std::sin(angle) * y;
      mesh.normals.emplace_back(n);
      mesh.positions.emplace_back(rod.axis[std::size_t(i)] + off + radius * n - mesh.origin);
    }
  }
  const auto at = [&](int i, int j) { return first + std::uint32_t(i * around + j % around); };
  for (int i = 0; i + 1 < rings; ++i)
    for (int j = 0; j < around; ++j) {
      mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
}

}  // namespace photohull::test
