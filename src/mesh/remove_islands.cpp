#include "mesh/remove_islands.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/gtx/hash.hpp>
#include <limits>
#include <unordered_map>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/error.h"
#include "mesh/simplify_mesh.h"

namespace photohull {
namespace {

struct Piece {
  double area = 0;     ///< voxels squared
  double support = 0;  ///< sum over the area
  glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
  std::vector<std::uint32_t> vertices;

  double mean_support() const { return area > 0 ? support / area : 0; }
  double size() const { return vertices.empty() ? 0 : double(glm::distance(low, high)); }
};

struct Pieces {
  std::vector<Piece> all;
  std::vector<std::uint32_t> of_vertex;
};

Pieces find_pieces(const TriMesh& mesh, std::span<const float> views, double voxel) {
  DisjointSets joined(mesh.positions.size());
  for (const auto& [a, b, c] : mesh.triangles) joined.unite(a, b), joined.unite(b, c);
  Pieces out;
  std::unordered_map<std::uint32_t, std::uint32_t> number;
  out.of_vertex.resize(mesh.positions.size());
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    const auto [at, added] = number.try_emplace(joined.root(v), std::uint32_t(out.all.size()));
    if (added) out.all.emplace_back();
    out.of_vertex[v] = at->second;
    Piece& piece = out.all[at->second];
    piece.vertices.push_back(v);
    piece.low = glm::min(piece.low, mesh.positions[v]);
    piece.high = glm::max(piece.high, mesh.positions[v]);
  }
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 across = glm::cross(glm::dvec3(mesh.positions[b] - mesh.positions[a]),
                                         glm::dvec3(mesh.positions[c] - mesh.positions[a]));
    const double area = glm::length(across) / 2 / (voxel * voxel);
    Piece& piece = out.all[out.of_vertex[a]];
    piece.area += area;
    for (const std::uint32_t v : {a, b, c})
      piece.support += area / 3 * double(mesh.confidence[v]) * std::max(0.0, double(views[v]) - 1);
  }
  return out;
}

/// Vertices by cells as wide as the longest gap.
class Cells {
 public:
  Cells(const TriMesh& mesh, double width) : mesh_(mesh), width_(float(width)) {
    for (std::uint32_t v = 0; v < mesh.positions.size(); ++v)
      cells_[cell(mesh.positions[v])].push_back(v);
  }

  /// Calls visit(vertex, distance) for the vertices within the cells around a position.
  void around(const glm::vec3& p, const auto& visit) const {
    const glm::ivec3 middle = cell(p);
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
          const auto found = cells_.find(middle + glm::ivec3(x, y, z));
          if (found == cells_.end()) continue;
          for (const std::uint32_t v : found->second)
            visit(v, double(glm::distance(p, mesh_.positions[v])));
        }
  }

 private:
  glm::ivec3 cell(const glm::vec3& p) const { return glm::floor(p / width_); }

  const TriMesh& mesh_;
  float width_;
  std::unordered_map<glm::ivec3, std::vector<std::uint32_t>> cells_;
};

}  // namespace

RemovedIslands remove_islands(TriMesh& mesh, std::span<const float> views,
                              const IslandOptions& options, MoreNumbers more) {
  PHOTOHULL_CHECK_OP(views.size(), ==, mesh.positions.size());
  PHOTOHULL_CHECK_OP(mesh.confidence.size(), ==, mesh.positions.size());
  if (!(options.voxel_size > 0))
    throw UsageError(concat("islands: voxel_size must be > 0, not ", options.voxel_size));
  if (mesh.triangles.empty()) return {};
  const Pieces pieces = find_pieces(mesh, views, options.voxel_size);
  const std::vector<Piece>& all = pieces.all;
  const auto main = std::uint32_t(
      std::max_element(all.begin(), all.end(),
                       [](const Piece& a, const Piece& b) { return a.support < b.support; }) -
      all.begin());

  // What is supported well enough, and then what of it is large enough in its row.
  std::vector<bool> supported(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const bool large = all[i].area >= options.large * all[main].area;
    supported[i] =
        all[i].mean_support() >=
        (large ? options.least_support_large : options.least_support) * all[main].mean_support();
  }
  const double longest = options.longest_gap * options.voxel_size;
  const Cells cells(mesh, longest);
  DisjointSets rows(all.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (!supported[i] || all[i].area >= options.least_area) continue;
    for (const std::uint32_t v : all[i].vertices)
      cells.around(mesh.positions[v], [&](std::uint32_t other, double distance) {
        const std::uint32_t j = pieces.of_vertex[other];
        if (j != i && supported[j] && distance <= std::min({longest, all[i].size(), all[j].size()}))
          rows.unite(i, j);
      });
  }
  std::vector<double> area(all.size());
  for (std::uint32_t i = 0; i < all.size(); ++i)
    if (supported[i]) area[rows.root(i)] += all[i].area;

  RemovedIslands removed;
  double total = 0;
  std::vector<bool> kept(all.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    kept[i] = i == main || (supported[i] && area[rows.root(i)] >= options.least_area);
    total += all[i].area;
    if (kept[i] || all[i].area == 0) continue;
    ++removed.pieces;
    removed.area_share += all[i].area;
  }
  if (total > 0) removed.area_share /= total;
  std::erase_if(mesh.triangles, [&](const auto& t) { return !kept[pieces.of_vertex[t[0]]]; });
  keep_used_vertices(mesh, more);
  return removed;
}

}  // namespace photohull
