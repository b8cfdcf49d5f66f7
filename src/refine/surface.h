// A mesh as surfels on a graph.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/grid.h"
#include "core/mesh.h"
#include "core/voxel_mask.h"

namespace photohull::refine {

/// Which vertices an edge joins: the neighbours of vertex i are
/// neighbours[first[i]] to neighbours[first[i + 1] - 1], in rising order, each once.
struct VertexGraph {
  std::vector<std::uint32_t> first;  ///< vertices + 1
  std::vector<std::uint32_t> neighbours;

  std::size_t vertices() const { return first.empty() ? 0 : first.size() - 1; }
  std::span<const std::uint32_t> of(std::size_t vertex) const {
    return {neighbours.data() + first[vertex], first[vertex + 1] - first[vertex]};
  }
};

/// Triangles have three different corners each.
VertexGraph make_graph(const TriMesh& mesh);

/// A mesh on the grid of its volume, with the graph of its edges; `positions` are those of its
/// vertices in voxels.
struct MeshSurfels {
  const GridSpec& grid;
  const TriMesh& mesh;
  const VertexGraph& graph;
  std::span<const glm::vec3> positions;
};

inline constexpr float kStillReach = 2.25f;  ///< voxels from the surface

/// The distances of a volume near its surface, while a step changes it: a third of its size.
class NearDistances {
 public:
  explicit NearDistances(const SparseVolume& volume);

  /// That of voxel `v` (voxel_offset) of a brick of the table, by its index there; nothing where it
  /// was not stored, or farther from the surface than kStillReach and a little.
  std::optional<float> at(std::size_t brick, int v) const;

 private:
  std::vector<std::uint32_t> table_;
  VoxelMask near_;
  std::vector<float> values_;  // by rank
};

/// Distances within kStillReach that a step left as they were: where `moved` is what it was
/// `before`, `volume` takes the latter, for each passage through a mesh rounds thin parts off. All
/// on one grid.
void keep_still(const NearDistances& before, const SparseVolume& moved, SparseVolume& volume);

}  // namespace photohull::refine
