#include "refine/close_unseen.h"

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>

namespace photohull::refine {
namespace {

using glm::ivec3;
using glm::vec3;

constexpr int kIterations = 150;    // of the Gauss-Seidel method
constexpr float kOver = 1.6f;       // over-relaxation
constexpr float kOpposite = -0.3f;  // cosine between the normals of a wall's two sides

/// Rises with z, then y, then x; cells lie within a million of the origin.
std::uint64_t key(const ivec3& cell) {
  constexpr int kMiddle = 1 << 20, kBits = 21;
  const auto part = [](int c) { return std::uint64_t(std::uint32_t(c + kMiddle)) & 0x1fffffu; };
  return part(cell.x) << (2 * kBits) | part(cell.y) << kBits | part(cell.z);
}

/// Seen vertices by the voxel that they lie in.
class SeenCells {
 public:
  SeenCells(const std::vector<vec3>& positions, const std::vector<vec3>& normals,
            const std::vector<bool>& seen)
      : positions_(positions), normals_(normals) {
    cells_.reserve(std::size_t(std::count(seen.begin(), seen.end(), true)));
    for (std::size_t i = 0; i < positions.size(); ++i)
      if (seen[i]) cells_.push_back({key(ivec3(glm::floor(positions[i]))), std::uint32_t(i)});
    std::sort(cells_.begin(), cells_.end());
  }
  /// Does seen surface that looks away from `normal` pass within a voxel of a point?
  bool wall_at(const vec3& point, const vec3& normal) const {
    const ivec3 cell(glm::floor(point));
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y) {
        const std::uint64_t last = key(cell + ivec3(x, y, 1));
        auto at =
            std::lower_bound(cells_.begin(), cells_.end(), Entry{key(cell + ivec3(x, y, -1)), 0});
        for (; at != cells_.end() && at->cell <= last; ++at)
          if (glm::dot(normals_[at->vertex], normal) < kOpposite &&
              glm::distance(positions_[at->vertex], point) < 1)
            return true;
      }
    return false;
  }

 private:
  const std::vector<vec3>& positions_;
  const std::vector<vec3>& normals_;
  struct Entry {
    std::uint64_t cell;
    std::uint32_t vertex;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> cells_;  // sorted
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
  const auto start = [&](std::size_t i) { return scale * mesh.positions[i] + offset; };
  std::vector<vec3> p(mesh.positions.size());
  std::vector<std::uint32_t> unseen;
  const std::vector<bool> wide = wide_patches(graph, seen, options);
  for (std::size_t i = 0; i < p.size(); ++i) {
    p[i] = start(i);
    if (wide[i] && !graph.of(i).empty()) unseen.push_back(std::uint32_t(i));
  }
  for (int iteration = 0; iteration < kIterations; ++iteration)
    for (const std::uint32_t i : unseen) {
      vec3 sum(0);
      for (const std::uint32_t j : graph.of(i)) sum += p[j];
      p[i] += kOver * (sum / float(graph.of(i).size()) - p[i]);
    }
  const SeenCells cells(p, mesh.normals, seen);  // what is seen has not moved
  std::vector<float> d(p.size(), 0.0f);
  const float longest = float(options.longest), thickness = float(options.thickness);
  for (const std::uint32_t i : unseen) {
    const vec3 n = mesh.normals[i];
    float move = std::clamp(glm::dot(p[i] - start(i), n), -longest, longest);
    for (float t = 0.5f; t <= thickness - move; t += 0.5f)
      if (cells.wall_at(start(i) - t * n, n)) {
        move = std::max(move, std::min(thickness - t, 0.0f));
        break;
      }
    d[i] = move;
  }
  return d;
}

}  // namespace photohull::refine
