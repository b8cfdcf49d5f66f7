#include "refine/surface.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace photohull::refine {
namespace {

constexpr float kStill = 0.01f;  // voxels

}  // namespace

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

void keep_still(const SparseVolume& before, const SparseVolume& moved, SparseVolume& volume) {
  tbb::parallel_for(std::size_t(0), volume.bricks.size(), [&](std::size_t slot) {
    const std::size_t index = volume.grid.brick_index(volume.bricks[slot]);
    const std::uint32_t a = before.table[index], b = moved.table[index];
    if (a >= SparseVolume::kInside || b >= SparseVolume::kInside) return;
    for (std::size_t v = 0; v < kBrickVoxels; ++v) {
      const float old = before.distance[a * kBrickVoxels + v];
      const float now = moved.distance[b * kBrickVoxels + v];
      if (std::abs(old - now) < kStill && std::abs(now) < kStillReach)
        volume.distance[slot * kBrickVoxels + v] = now;
    }
  });
}

}  // namespace photohull::refine
