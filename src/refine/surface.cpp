#include "refine/surface.h"

#include <algorithm>

namespace photohull::refine {

VertexGraph make_graph(const TriMesh& mesh) {
  VertexGraph graph;
  const std::size_t n = mesh.positions.size();
  // Every edge of a closed mesh belongs to two triangles, once in each direction.
  std::vector<std::uint32_t> start(n + 1, 0);
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) start[v + 1] += 2;
  for (std::size_t i = 0; i < n; ++i) start[i + 1] += start[i];
  std::vector<std::uint32_t> all(start[n]), next(start.begin(), start.end() - 1);
  for (const auto& [a, b, c] : mesh.triangles) {
    all[next[a]++] = b, all[next[a]++] = c;
    all[next[b]++] = c, all[next[b]++] = a;
    all[next[c]++] = a, all[next[c]++] = b;
  }
  graph.first.resize(n + 1, 0);
  graph.neighbours.reserve(all.size() / 2);
  for (std::size_t i = 0; i < n; ++i) {
    const auto from = all.begin() + start[i], to = all.begin() + start[i + 1];
    std::sort(from, to);
    graph.neighbours.insert(graph.neighbours.end(), from, std::unique(from, to));
    graph.first[i + 1] = std::uint32_t(graph.neighbours.size());
  }
  return graph;
}

}  // namespace photohull::refine
