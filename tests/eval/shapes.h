// Meshes with known distances, for the tests of evaluation.
#pragma once

#include <cmath>
#include <map>
#include <utility>

#include "core/mesh.h"

namespace photohull::test {

/// A plate in the plane z, facing +z, of n x n squares over [x, x + edge] x [y, y + edge].
inline TriMesh plate(double x, double y, double z, double edge, int n) {
  TriMesh mesh;
  mesh.origin = {x, y, z};
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) mesh.positions.emplace_back(edge * i / n, edge * j / n, 0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const auto a = std::uint32_t(j * (n + 1) + i);
      const std::uint32_t b = a + 1, c = a + std::uint32_t(n) + 1, d = c + 1;
      mesh.triangles.push_back({a, b, d});
      mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

/// A closed box with outward faces.
inline TriMesh box(const glm::dvec3& low, const glm::dvec3& high) {
  TriMesh mesh;
  mesh.origin = low;
  for (int i = 0; i < 8; ++i)
    mesh.positions.emplace_back((high - low) * glm::dvec3(i & 1, (i >> 1) & 1, i >> 2));
  const std::uint32_t quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (const auto& q : quads) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

/// A closed sphere: an octahedron whose triangles are divided `divisions` times; vertices shared.
inline TriMesh sphere(const glm::dvec3& centre, double radius, int divisions) {
  std::vector<glm::dvec3> p = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<std::array<std::uint32_t, 3>> faces = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                                     {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int round = 0; round < divisions; ++round) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, fresh] = middles.try_emplace(std::minmax(a, b), std::uint32_t(p.size()));
      if (fresh) p.push_back(glm::normalize(p[a] + p[b]));
      return entry->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  TriMesh mesh;
  mesh.origin = centre;
  for (const glm::dvec3& v : p) mesh.positions.emplace_back(radius * v);
  mesh.triangles = std::move(faces);
  return mesh;
}

inline TriMesh moved(TriMesh mesh, const glm::dvec3& by) {
  mesh.origin += by;
  return mesh;
}

/// Two meshes as one; coordinates become relative to the first one's origin.
inline TriMesh together(TriMesh mesh, const TriMesh& other) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (std::size_t i = 0; i < other.positions.size(); ++i)
    mesh.positions.emplace_back(other.world(i) - mesh.origin);
  for (const auto& [a, b, c] : other.triangles)
    mesh.triangles.push_back({first + a, first + b, first + c});
  return mesh;
}

inline TriMesh turned_inside_out(TriMesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

}  // namespace photohull::test
