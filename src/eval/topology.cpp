#include "eval/topology.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace photohull::eval {

std::vector<std::uint32_t> joined_vertices(const TriMesh& mesh) {
  std::vector<std::uint32_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t i) {
    const glm::vec3& p = mesh.positions[i];
    return std::tuple(p.x, p.y, p.z);
  };
  tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const auto first = key(a), second = key(b);
    return first != second ? first < second : a < b;
  });
  std::vector<std::uint32_t> joined(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && key(order[i]) == key(order[i - 1]);
    joined[order[i]] = same ? joined[order[i - 1]] : order[i];
  }
  return joined;
}

std::vector<HalfEdge> sorted_half_edges(const TriMesh& mesh,
                                        const std::vector<std::uint32_t>& joined) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (int side = 0; side < 3; ++side) {
      const std::uint32_t from = joined[mesh.triangles[t][side]];
      const std::uint32_t to = joined[mesh.triangles[t][(side + 1) % 3]];
      if (from == to) continue;
      const std::uint64_t key = (std::uint64_t(std::min(from, to)) << 32) | std::max(from, to);
      edges.push_back({key, t, std::uint8_t(side), from < to});
    }
  tbb::parallel_sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tuple(a.key, a.triangle, a.side) < std::tuple(b.key, b.triangle, b.side);
  });
  return edges;
}

glm::dvec3 area_vector(const TriMesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const glm::dvec3 corner(mesh.positions[a]);
  return glm::cross(glm::dvec3(mesh.positions[b]) - corner, glm::dvec3(mesh.positions[c]) - corner);
}

TriMesh without_degenerate_faces(const TriMesh& mesh) {
  TriMesh result;
  result.positions = mesh.positions;
  result.origin = mesh.origin;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    if (glm::length(area_vector(mesh, t)) > 0) result.triangles.push_back(mesh.triangles[t]);
  return result;
}

}  // namespace photohull::eval
