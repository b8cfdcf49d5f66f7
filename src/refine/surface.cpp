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
  std::vector<std::uint32_t> next(n + 1, 0);
  for (const auto& t : mesh.triangles)
    for (const std::uint32_t v : t) next[v + 1] += 2;
  for (std::size_t i = 0; i < n; ++i) next[i + 1] += next[i];
  std::vector<std::uint32_t>& all = graph.neighbours;
  all.resize(next[n]);
  for (const auto& [a, b, c] : mesh.triangles) {
    all[next[a]++] = b, all[next[a]++] = c;
    all[next[b]++] = c, all[next[b]++] = a;
    all[next[c]++] = a, all[next[c]++] = b;
  }
  // Each vertex's list, which ends at next[i] now, becomes shorter and moves to the front.
  graph.first.resize(n + 1, 0);
  auto end = all.begin();
  std::uint32_t start = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const auto from = all.begin() + start, to = all.begin() + next[i];
    start = next[i];
    std::sort(from, to);
    end = std::copy(from, std::unique(from, to), end);
    graph.first[i + 1] = std::uint32_t(end - all.begin());
  }
  all.erase(end, all.end());
  all.shrink_to_fit();
  return graph;
}

NearDistances::NearDistances(const SparseVolume& volume)
    : table_(volume.table), near_(volume.bricks.size()) {
  constexpr float kNear = kStillReach + 2 * kStill;
  const auto for_near = [&](std::size_t brick, auto&& f) {
    for (std::size_t i = brick * kBrickVoxels; i < (brick + 1) * kBrickVoxels; ++i)
      if (std::abs(volume.distance[i]) < kNear) f(i);
  };
  const std::size_t bricks = volume.bricks.size();
  tbb::parallel_for(std::size_t(0), bricks,
                    [&](std::size_t b) { for_near(b, [&](std::size_t i) { near_.mark(i); }); });
  near_.count();
  values_.resize(near_.marked());
  tbb::parallel_for(std::size_t(0), bricks, [&](std::size_t b) {
    std::size_t rank = near_.rank(b * kBrickVoxels);
    for_near(b, [&](std::size_t i) { values_[rank++] = volume.distance[i]; });
  });
}

std::optional<float> NearDistances::at(std::size_t brick, int v) const {
  const std::uint32_t slot = table_[brick];
  if (slot >= SparseVolume::kInside) return {};
  const std::size_t voxel = std::size_t(slot) * kBrickVoxels + std::size_t(v);
  if (!near_.has(voxel)) return {};
  return values_[near_.rank(voxel)];
}

void keep_still(const NearDistances& before, const SparseVolume& moved, SparseVolume& volume) {
  tbb::parallel_for(std::size_t(0), volume.bricks.size(), [&](std::size_t slot) {
    const std::size_t index = volume.grid.brick_index(volume.bricks[slot]);
    const std::uint32_t b = moved.table[index];
    if (b >= SparseVolume::kInside) return;
    for (int v = 0; v < kBrickVoxels; ++v) {
      const float now = moved.distance[b * std::size_t(kBrickVoxels) + std::size_t(v)];
      if (!(std::abs(now) < kStillReach)) continue;
      const std::optional<float> old = before.at(index, v);
      if (old && std::abs(*old - now) < kStill)
        volume.distance[slot * kBrickVoxels + std::size_t(v)] = now;
    }
  });
}

}  // namespace photohull::refine
