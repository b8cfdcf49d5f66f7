// Blocks of a mesh are simplified on their own, in parallel and in coordinates of their own: the
// library's quadrics are single precision, too coarse for a voxel's quarter on a large mesh.
// Borders between blocks stay, so blocks are drawn anew, half a block further, for a second pass.
// What is left cuts every convex part and fills every hollow: its edges and vertices are then
// fitted to the mesh as a whole, which takes a third off the mean distance and ends the bias.
#include "mesh/simplify_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "core/error.h"
#include "mesh/fit_mesh.h"
#include "mesh/mesh_samples.h"
#include "mesh/simplify_block.h"
#include "raycast/closest_point.h"

namespace photohull {
namespace {

constexpr double kBlock = 64;  // mean edges, the side of a block
/// Shares of the error that the passes may spend; distances add up at most. The rest is left for
/// what lies between the points at which they are measured.
constexpr double kPassShare[] = {0.2, 0.75};
constexpr double kFitShare = 0.95;  // what fits the result is measured against the mesh itself

using Flags = std::vector<std::uint8_t>;

struct Block {
  std::vector<std::uint32_t> triangles;  ///< of the mesh
  std::vector<std::uint32_t> vertices;   ///< of the mesh, ascending; the block's are their ranks
  TriMesh mesh;                          ///< relative to the block's own origin
  Flags kept;                            ///< triangles that must stay
  Triangles result;                      ///< of the mesh's vertices
};

/// Triangles by the cells of a cubic lattice in which their middles lie.
std::vector<Block> divide(const TriMesh& mesh, double size, double shift) {
  std::map<std::tuple<int, int, int>, Block> cells;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const glm::dvec3 middle = (glm::dvec3(mesh.positions[a]) + glm::dvec3(mesh.positions[b]) +
                               glm::dvec3(mesh.positions[c])) /
                              3.0;
    const glm::ivec3 cell(glm::floor(middle / size + shift));
    cells[{cell.x, cell.y, cell.z}].triangles.push_back(t);
  }
  std::vector<Block> blocks;
  for (auto& [cell, block] : cells) blocks.push_back(std::move(block));
  return blocks;
}

void fill(const TriMesh& mesh, Block& block) {
  for (const std::uint32_t t : block.triangles)
    block.vertices.insert(block.vertices.end(), mesh.triangles[t].begin(), mesh.triangles[t].end());
  std::sort(block.vertices.begin(), block.vertices.end());
  block.vertices.erase(std::unique(block.vertices.begin(), block.vertices.end()),
                       block.vertices.end());
  const auto rank = [&](std::uint32_t v) {
    return std::uint32_t(std::lower_bound(block.vertices.begin(), block.vertices.end(), v) -
                         block.vertices.begin());
  };
  const glm::vec3 origin = mesh.positions[block.vertices[0]];
  for (const std::uint32_t v : block.vertices)
    block.mesh.positions.push_back(mesh.positions[v] - origin);
  for (const std::uint32_t t : block.triangles) {
    const auto& [a, b, c] = mesh.triangles[t];
    block.mesh.triangles.push_back({rank(a), rank(b), rank(c)});
  }
  block.kept.assign(block.triangles.size(), 0);
}

void simplify(Block& block, const BlockLimits& limits) {
  block.result = simplify_block(block.mesh, limits, block.kept);
  for (auto& triangle : block.result)
    for (std::uint32_t& v : triangle) v = block.vertices[v];
}

/// Marks the ends of edges that several triangles run through in the same direction. Blocks cannot
/// see that a neighbour drew the same edge between two vertices of their common border.
bool mark_doubled_edges(const std::vector<Block>& blocks, Flags& vertices) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const Block& block : blocks)
    for (const auto& t : block.result)
      for (int i = 0; i < 3; ++i) edges.emplace_back(t[i], t[(i + 1) % 3]);
  std::sort(edges.begin(), edges.end());
  bool any = false;
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i] == edges[i - 1]) {
      vertices[edges[i].first] = vertices[edges[i].second] = 1;
      any = true;
    }
  return any;
}

/// Keeps triangles around marked vertices; true when that changes the block.
bool keep_marked(const Flags& marked, int rings, Block& block) {
  Flags local(block.vertices.size());
  for (std::size_t i = 0; i < local.size(); ++i) local[i] = marked[block.vertices[i]];
  Flags kept = block.kept;
  mark_rings(block.mesh.triangles, rings, local, kept);
  if (kept == block.kept) return false;
  block.kept = std::move(kept);
  return true;
}

Triangles simplify_pass(const TriMesh& mesh, double size, double shift, const BlockLimits& limits) {
  std::vector<Block> blocks = divide(mesh, size, shift);
  tbb::parallel_for(std::size_t(0), blocks.size(), [&](std::size_t i) {
    fill(mesh, blocks[i]);
    simplify(blocks[i], limits);
  });
  for (int rings = 1;; rings *= 2) {
    Flags marked(mesh.positions.size());
    if (!mark_doubled_edges(blocks, marked)) break;
    std::vector<std::uint8_t> changed(blocks.size());
    tbb::parallel_for(std::size_t(0), blocks.size(), [&](std::size_t i) {
      changed[i] = keep_marked(marked, rings, blocks[i]);
      if (changed[i]) simplify(blocks[i], limits);
    });
    // Edges that were doubled in the mesh remain.
    if (std::find(changed.begin(), changed.end(), 1) == changed.end()) break;
  }
  Triangles triangles;
  for (const Block& block : blocks)
    triangles.insert(triangles.end(), block.result.begin(), block.result.end());
  return triangles;
}

template <typename T>
void take(std::vector<T>& values, const std::vector<std::uint32_t>& which) {
  if (values.empty()) return;
  std::vector<T> taken;
  for (const std::uint32_t i : which) taken.push_back(values[i]);
  values = std::move(taken);
}

/// One direction; appends to `distances`.
void add_distances(const TriMesh& from, const TriMesh& to, double spacing,
                   std::vector<float>& distances) {
  const ClosestPoint surface(to);
  constexpr std::size_t kRun = 4096;
  const std::size_t items = from.positions.size() + from.triangles.size();
  std::vector<std::vector<float>> runs((items + kRun - 1) / kRun);
  tbb::parallel_for(std::size_t(0), runs.size(), [&](std::size_t run) {
    std::uint32_t hint = 0;
    const auto measure = [&](const glm::dvec3& p) {
      const NearestPoint nearest = surface.nearest(p, hint);
      hint = nearest.triangle;
      runs[run].push_back(float(nearest.distance));
    };
    for (std::size_t i = run * kRun; i < std::min(items, (run + 1) * kRun); ++i) {
      if (i < from.positions.size()) {
        measure(from.world(i));
      } else {
        const auto& [a, b, c] = from.triangles[i - from.positions.size()];
        for_points({from.world(a), from.world(b), from.world(c)}, spacing, measure);
      }
    }
  });
  for (const auto& run : runs) distances.insert(distances.end(), run.begin(), run.end());
}

}  // namespace

double mean_edge(const TriMesh& mesh) {
  double sum = 0;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i)
      sum += glm::distance(mesh.positions[t[i]], mesh.positions[t[(i + 1) % 3]]);
  return mesh.triangles.empty() ? 0 : sum / (3 * double(mesh.triangles.size()));
}

MeshDistance measure_distance(const TriMesh& first, const TriMesh& second, double spacing) {
  PHOTOHULL_CHECK_OP(spacing, >, 0.0);
  std::vector<float> distances;
  add_distances(first, second, spacing, distances);
  add_distances(second, first, spacing, distances);
  std::sort(distances.begin(), distances.end());
  const auto at = [&](double share) {
    return double(distances[std::size_t(share * double(distances.size() - 1))]);
  };
  const double sum = std::accumulate(distances.begin(), distances.end(), 0.0);
  return {sum / double(distances.size()), at(0.95), at(0.999), at(1)};
}

void keep_used_vertices(TriMesh& mesh, MoreNumbers more) {
  std::vector<std::uint32_t> rank(mesh.positions.size()), used;
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t v : triangle) rank[v] = 1;
  for (std::uint32_t v = 0; v < rank.size(); ++v)
    if (rank[v]) {
      rank[v] = std::uint32_t(used.size());
      used.push_back(v);
    }
  take(mesh.positions, used);
  take(mesh.normals, used);
  take(mesh.colours, used);
  take(mesh.confidence, used);
  for (std::vector<float>* numbers : more) take(*numbers, used);
  for (auto& triangle : mesh.triangles)
    for (std::uint32_t& v : triangle) v = rank[v];
}

TriMesh simplify_mesh(const TriMesh& mesh, double error) {
  if (!(std::isfinite(error) && error >= 0))
    throw UsageError(concat("mesh error is ", error, "; choose a finite number, 0 or more"));
  TriMesh result = mesh;
  const double edge = mean_edge(mesh);
  if (error == 0 || !(edge > 0)) return result;
  double shift = 0;
  for (const double share : kPassShare) {
    result.triangles = simplify_pass(result, kBlock * edge, shift, {share * error, edge});
    shift += 0.5;
  }
  keep_used_vertices(result);
  fit_mesh(mesh, {kFitShare * error, edge}, result);
  return result;
}

}  // namespace photohull
