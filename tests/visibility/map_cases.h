// Triangles, viewpoints and samples for the tests of visibility maps.
#pragma once

#include <vector>

#include "core/camera.h"
#include "core/mesh.h"
#include "support/cameras.h"
#include "visibility/kernels/visibility_map.h"

namespace photohull::visibility::test_cases {

inline const Box kBox{{-1, -1, -1}, {1, 1, 1}};

/// Triangles of mixed sizes in the box, with its origin far from the world's.
inline TriMesh random_triangles(test::Rng& rng, int count, double largest = 1) {
  TriMesh mesh;
  mesh.origin = {0.3, -0.2, 0.1};
  for (int i = 0; i < count; ++i) {
    const glm::dvec3 centre = test::uniform_in(rng, kBox);
    const double size = largest * std::pow(10.0, test::uniform(rng, -1.5, 0));
    for (int k = 0; k < 3; ++k)
      mesh.positions.push_back(
          glm::vec3(centre + size * test::random_direction(rng) - mesh.origin));
    const auto first = std::uint32_t(3 * i);
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// A sample on a triangle, with its neighbours' steps as a camera a little way off would have them.
inline Sample sample_on(test::Rng& rng, const TriMesh& mesh, std::uint32_t triangle) {
  const auto& t = mesh.triangles[triangle];
  const glm::dvec3 a = mesh.world(t[0]), b = mesh.world(t[1]), c = mesh.world(t[2]);
  double u = test::uniform(rng, 0, 1), v = test::uniform(rng, 0, 1);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  Sample s;
  s.position = a + u * (b - a) + v * (c - a);
  s.normal = glm::normalize(glm::cross(b - a, c - a));
  const glm::dvec3 x = glm::normalize(b - a), y = glm::cross(s.normal, x);
  s.step_x = 0.01 * (x + 0.3 * y);
  s.step_y = 0.012 * (y - 0.2 * x);
  s.id = triangle;
  return s;
}

inline std::vector<Sample> random_samples(test::Rng& rng, const TriMesh& mesh, int count) {
  std::vector<Sample> out;
  for (int i = 0; i < count; ++i) {
    out.push_back(sample_on(rng, mesh, std::uint32_t(rng() % mesh.triangles.size())));
    if (i % 3 == 0) {  // off the surface
      out.back().position = test::uniform_in(rng, kBox);
      out.back().id = shaders::kNoTriangle;
    }
  }
  return out;
}

}  // namespace photohull::visibility::test_cases
