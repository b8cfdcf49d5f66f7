#include "refine/close_unseen.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace photohull::refine {
namespace {

using glm::ivec3;
using glm::vec3;

constexpr float kOver = 1.6f;       // over-relaxation
constexpr float kOpposite = -0.3f;  // cosine between the normals of a wall's two sides

std::int64_t key(const ivec3& cell) {
  return (std::int64_t(cell.x) << 42) ^ (std::int64_t(cell.y) << 21) ^ std::int64_t(cell.z);
}

/// Seen vertices by the voxel that they lie in.
class SeenCells {
 public:
  SeenCells(const std::vector<vec3>& positions, const std::vector<vec3>& normals,
            const std::vector<bool>& seen)
      : positions_(positions), normals_(normals) {
    for (std::size_t i = 0; i < positions.size(); ++i)
      if (seen[i]) cells_[key(ivec3(glm::floor(positions[i])))].push_back(std::uint32_t(i));
  }
  /// Does seen surface that looks away from `normal` pass within a voxel of a point?
  bool wall_at(const vec3& point, const vec3& normal) const {
    const ivec3 cell(glm::floor(point));
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const auto found = cells_.find(key(cell + ivec3(x, y, z)));
          if (found == cells_.end()) continue;
          for (const std::uint32_t i : found->second)
            if (glm::dot(normals_[i], normal) < kOpposite &&
                glm::distance(positions_[i], point) < 1)
              return true;
        }
    return false;
  }

 private:
  const std::vector<vec3>& positions_;
  const std::vector<vec3>& normals_;
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> cells_;
};

/// Grows the marked set by one ring of neighbours.
void grow(const VertexGraph& graph, std::vector<bool>& marked) {
  const std::vector<bool> old = marked;
  for (std::size_t i = 0; i < marked.size(); ++i)
    for (const std::uint32_t j : graph.of(i))
      if (old[j]) marked[i] = true;
}

/// The unseen vertices without patches narrower than twice the rings, and without a belt around the
/// rest: an opening, and a little less.
std::vector<bool> wide_patches(const VertexGraph& graph, const std::vector<bool>& seen,
                               const CloseOptions& options) {
  std::vector<bool> marked = seen;
  for (int i = 0; i < options.rings; ++i) grow(graph, marked);
  marked.flip();
  for (int i = 0; i < options.rings - options.belt; ++i) grow(graph, marked);
  for (std::size_t i = 0; i < marked.size(); ++i) marked[i] = marked[i] && !seen[i];
  return marked;
}

}  // namespace

std::vector<float> close_unseen(const GridSpec& grid, const TriMesh& mesh, const VertexGraph& graph,
                                const std::vector<bool>& seen, const CloseOptions& options) {
  const float scale = float(1 / grid.voxel_size);
  const vec3 offset((mesh.origin - grid.origin) / grid.voxel_size);
  std::vector<vec3> start(mesh.positions.size());
  std::vector<std::uint32_t> unseen;
  const std::vector<bool> wide = wide_patches(graph, seen, options);
  for (std::size_t i = 0; i < start.size(); ++i) {
    start[i] = scale * mesh.positions[i] + offset;
    if (wide[i] && !graph.of(i).empty()) unseen.push_back(std::uint32_t(i));
  }
  std::vector<vec3> p = start;
  for (int iteration = 0; iteration < options.iterations; ++iteration)
    for (const std::uint32_t i : unseen) {
      vec3 sum(0);
      for (const std::uint32_t j : graph.of(i)) sum += p[j];
      p[i] += kOver * (sum / float(graph.of(i).size()) - p[i]);
    }
  const SeenCells cells(start, mesh.normals, seen);
  std::vector<float> d(start.size(), 0.0f);
  const float longest = float(options.longest), thickness = float(options.thickness);
  for (const std::uint32_t i : unseen) {
    const vec3 n = mesh.normals[i];
    float move = std::clamp(glm::dot(p[i] - start[i], n), -longest, longest);
    for (float t = 0.5f; t <= thickness - move; t += 0.5f)
      if (cells.wall_at(start[i] - t * n, n)) {
        move = std::max(move, std::min(thickness - t, 0.0f));
        break;
      }
    d[i] = move;
  }
  return d;
}

}  // namespace photohull::refine
