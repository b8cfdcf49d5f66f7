#include "mesh/stitch_parts.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/gtx/hash.hpp>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/error.h"
#include "mesh/join_meshes.h"
#include "mesh/mesh_edges.h"
#include "mesh/simplify_mesh.h"

namespace photohull {
namespace {

constexpr std::size_t kLongestGap = 1000;  // edges: more are no gap between parts
constexpr double kWidestGap = 8;           // times the reach, from one part to the other

/// Sides that no triangle runs along the other way, in order.
std::vector<Side> border_of(const TriMesh& mesh) {
  const std::vector<Side> sides = sorted_sides(mesh.triangles);
  std::vector<Side> out;
  for (const Side& side : sides)
    if (!opposite(sides, side)) out.push_back(side);
  return out;
}

/// Drops triangles that run along a side that an earlier one runs along the same way: where two
/// parts both have what lies at their border.
void drop_doubled(TriMesh& mesh) {
  const std::vector<Side> sides = sorted_sides(mesh.triangles);
  std::vector<bool> doubled(mesh.triangles.size(), false);
  for (std::size_t i = 1; i < sides.size(); ++i)
    if (sides[i].from == sides[i - 1].from && sides[i].to == sides[i - 1].to)
      doubled[sides[i].triangle] = true;
  std::size_t triangle = 0;
  std::erase_if(mesh.triangles, [&](const auto&) { return doubled[triangle++]; });
}

constexpr std::uint32_t kSeam = std::numeric_limits<std::uint32_t>::max();  // of several parts

/// A vertex at the border of a part.
struct BorderVertex {
  std::uint32_t vertex = 0;  // of the joined mesh
  std::size_t part = 0;
};

/// Which vertices become one: sets, each with a vertex of every part at most.
class Seam {
 public:
  Seam(const TriMesh& mesh, std::vector<BorderVertex> border, double reach)
      : mesh_(mesh), border_(std::move(border)), sets_(border_.size()), parts_(border_.size()) {
    std::iota(sets_.begin(), sets_.end(), std::size_t(0));
    for (std::size_t i = 0; i < border_.size(); ++i) parts_[i] = {border_[i].part};
    for (const Pair& pair : pairs(reach)) unite(set_of(pair.a), set_of(pair.b));
  }

  /// The border's vertices by their sets of two or more.
  std::vector<std::vector<std::uint32_t>> sets() {
    std::map<std::size_t, std::vector<std::uint32_t>> members;
    for (std::size_t i = 0; i < border_.size(); ++i)
      if (parts_[set_of(i)].size() > 1) members[set_of(i)].push_back(border_[i].vertex);
    std::vector<std::vector<std::uint32_t>> out;
    for (auto& [set, vertices] : members) out.push_back(std::move(vertices));
    return out;
  }

 private:
  struct Pair {
    double distance = 0;
    std::size_t a = 0, b = 0;
    auto operator<=>(const Pair&) const = default;
  };

  /// Of different parts and within reach, the nearest first.
  std::vector<Pair> pairs(double reach) const {
    const auto cell = [&](std::size_t i) {
      return glm::ivec3(glm::floor(glm::dvec3(mesh_.positions[border_[i].vertex]) / reach));
    };
    std::unordered_map<glm::ivec3, std::vector<std::size_t>> cells;
    for (std::size_t i = 0; i < border_.size(); ++i) cells[cell(i)].push_back(i);
    std::vector<Pair> out;
    for (std::size_t i = 0; i < border_.size(); ++i)
      for (int k = 0; k < 27; ++k) {
        const auto found = cells.find(cell(i) + glm::ivec3(k / 9, k / 3 % 3, k % 3) - 1);
        if (found == cells.end()) continue;
        for (const std::size_t j : found->second) {
          if (j <= i || border_[i].part == border_[j].part) continue;
          const double distance =
              glm::distance(mesh_.positions[border_[i].vertex], mesh_.positions[border_[j].vertex]);
          if (distance <= reach) out.push_back({distance, i, j});
        }
      }
    std::sort(out.begin(), out.end());
    return out;
  }

  std::size_t set_of(std::size_t i) {
    while (sets_[i] != i) i = sets_[i] = sets_[sets_[i]];
    return i;
  }

  void unite(std::size_t a, std::size_t b) {
    if (a == b) return;
    const auto shared = [&](std::size_t part) {
      return std::ranges::find(parts_[b], part) != parts_[b].end();
    };
    if (std::ranges::any_of(parts_[a], shared)) return;
    sets_[b] = a;
    parts_[a].insert(parts_[a].end(), parts_[b].begin(), parts_[b].end());
    parts_[b].clear();
  }

  const TriMesh& mesh_;
  std::vector<BorderVertex> border_;
  std::vector<std::size_t> sets_;                // by union-find
  std::vector<std::vector<std::size_t>> parts_;  // of each set's vertices
};

template <typename T>
T mean_of(const std::vector<T>& values, const std::vector<std::uint32_t>& some) {
  T sum(0);
  for (const std::uint32_t i : some) sum += values[i];
  return sum / float(some.size());
}

/// A vertex becomes the mean of some.
void average(const std::vector<std::uint32_t>& some, std::uint32_t vertex, TriMesh& mesh) {
  mesh.positions[vertex] = mean_of(mesh.positions, some);
  if (!mesh.normals.empty()) {
    const glm::vec3 sum = mean_of(mesh.normals, some);
    if (const float length = glm::length(sum); length > 0) mesh.normals[vertex] = sum / length;
  }
  if (!mesh.colours.empty()) mesh.colours[vertex] = mean_of(mesh.colours, some);
  if (!mesh.confidence.empty()) mesh.confidence[vertex] = mean_of(mesh.confidence, some);
}

/// Loops of kLongestGap sides at most, without a vertex that comes twice, along sides of a border,
/// each side in one at most.
class Loops {
 public:
  explicit Loops(const std::vector<Side>& border) {
    for (const Side& side : border) next_[side.from].push_back(side.to);
  }

  /// Goes on from a vertex as long as there are sides that no loop has; visit(loop).
  template <typename Visit>
  void walk(std::uint32_t first, const Visit& visit) {
    std::vector<std::uint32_t> path{first};
    for (auto* ends = &next_[first]; !ends->empty(); ends = &next_[path.back()]) {
      const std::uint32_t end = ends->back();
      ends->pop_back();
      const auto met = std::find(path.end() - std::ptrdiff_t(std::min(path.size(), kLongestGap)),
                                 path.end(), end);
      if (met == path.end()) {
        path.push_back(end);
        continue;
      }
      visit(std::vector<std::uint32_t>(met, path.end()));
      path.erase(met + 1, path.end());
    }
  }

 private:
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> next_;
};

/// Is what a loop goes around a gap between parts, whose borders are near each other all along it?
/// `parts`: of the vertices, and kSeam of those that several have.
bool is_gap(const std::vector<std::uint32_t>& loop, const std::vector<std::uint32_t>& parts,
            const TriMesh& mesh, double reach) {
  if (loop.size() < 3) return false;
  return std::ranges::all_of(loop, [&](std::uint32_t a) {
    return parts[a] == kSeam || std::ranges::any_of(loop, [&](std::uint32_t b) {
             return parts[b] != parts[a] &&
                    double(glm::distance(mesh.positions[a], mesh.positions[b])) <=
                        kWidestGap * reach;
           });
  });
}

/// Triangles that fill a loop, and run the other way: the corner whose neighbours are nearest to
/// each other is cut off again and again, but for neighbours that a side of the mesh (`sides`)
/// joins already.
void fill(std::vector<std::uint32_t> loop, const std::vector<Side>& sides, TriMesh& mesh) {
  const auto joined = [&](std::uint32_t a, std::uint32_t b) {
    return opposite(sides, {a, b, 0}) || opposite(sides, {b, a, 0});
  };
  while (loop.size() > 3) {
    const std::size_t n = loop.size();
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const std::uint32_t before = loop[(i + n - 1) % n], after = loop[(i + 1) % n];
      const double length = double(glm::distance(mesh.positions[before], mesh.positions[after]));
      if (length < least && !joined(before, after)) best = i, least = length;
    }
    mesh.triangles.push_back({loop[(best + 1) % n], loop[best], loop[(best + n - 1) % n]});
    loop.erase(loop.begin() + std::ptrdiff_t(best));
  }
  mesh.triangles.push_back({loop[2], loop[1], loop[0]});
}

}  // namespace

Stitched stitch_parts(std::vector<TriMesh> parts, double reach) {
  PHOTOHULL_CHECK_OP(reach, >, 0.0);
  Stitched out;
  std::vector<BorderVertex> border;
  std::vector<std::uint32_t> part_of;  // of each vertex
  for (std::size_t part = 0; part < parts.size(); ++part) {
    const auto first = std::uint32_t(out.mesh.positions.size());
    std::vector<std::uint32_t> vertices;
    for (const Side& side : border_of(parts[part]))
      vertices.insert(vertices.end(), {side.from, side.to});
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const std::uint32_t v : vertices) border.push_back({first + v, part});
    append_mesh(parts[part], out.mesh);
    part_of.resize(out.mesh.positions.size(), std::uint32_t(part));
    parts[part] = {};
  }
  std::vector<std::uint32_t> stands_for(out.mesh.positions.size());
  std::iota(stands_for.begin(), stands_for.end(), 0u);
  for (const std::vector<std::uint32_t>& set : Seam(out.mesh, border, reach).sets()) {
    average(set, set.front(), out.mesh);
    for (const std::uint32_t v : set) stands_for[v] = set.front();
    part_of[set.front()] = kSeam;
    ++out.seam_vertices;
  }
  for (auto& t : out.mesh.triangles)
    for (std::uint32_t& v : t) v = stands_for[v];
  std::erase_if(out.mesh.triangles,
                [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  drop_doubled(out.mesh);
  const std::vector<Side> sides = sorted_sides(out.mesh.triangles), open = border_of(out.mesh);
  Loops loops(open);
  for (const Side& side : open)
    loops.walk(side.from, [&](std::vector<std::uint32_t> loop) {
      if (!is_gap(loop, part_of, out.mesh, reach)) return;
      fill(std::move(loop), sides, out.mesh);
      ++out.filled;
    });
  for (const Side& side : border_of(out.mesh))
    out.open_edges += part_of[side.from] == kSeam || part_of[side.to] == kSeam;
  keep_used_vertices(out.mesh);
  return out;
}

}  // namespace photohull
