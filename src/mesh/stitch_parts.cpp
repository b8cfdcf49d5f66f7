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

#include "core/disjoint_sets.h"
#include "core/error.h"
#include "mesh/fill_gaps.h"
#include "mesh/join_meshes.h"
#include "mesh/mesh_edges.h"

namespace photohull {
namespace {

constexpr double kLargestDust = 8;  // times the reach, from corner to corner

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

/// Appends a vertex of another mesh that has the same origin, with its attributes.
void add_vertex(const TriMesh& from, std::size_t vertex, TriMesh& to) {
  to.positions.push_back(from.positions[vertex]);
  if (!from.normals.empty()) to.normals.push_back(from.normals[vertex]);
  if (!from.colours.empty()) to.colours.push_back(from.colours[vertex]);
  if (!from.confidence.empty()) to.confidence.push_back(from.confidence[vertex]);
}

/// The rims as one mesh, which joining changes.
class Joining {
 public:
  explicit Joining(std::vector<Rim> rims) : rims_(std::move(rims)) {
    for (std::size_t part = 0; part < rims_.size(); ++part) {
      Rim& rim = rims_[part];
      const auto first = std::uint32_t(mesh_.positions.size());
      first_.push_back(first);
      for (std::uint32_t v = 0; v < rim.vertices.size(); ++v)
        if (rim.border[v]) border_.push_back({first + v, part});
      on_border_.insert(on_border_.end(), rim.border.begin(), rim.border.end());
      append_mesh(rim.mesh, mesh_);
      part_of_.resize(mesh_.positions.size(), std::uint32_t(part));
      rim.mesh = {};
    }
    stands_for_.resize(mesh_.positions.size());
    std::iota(stands_for_.begin(), stands_for_.end(), 0u);
  }

  Stitched join(double reach) {
    Stitched out;
    for (const std::vector<std::uint32_t>& set : Seam(mesh_, border_, reach).sets()) {
      average(set, set.front(), mesh_);
      for (const std::uint32_t v : set) stands_for_[v] = set.front();
      part_of_[set.front()] = kSeam;
      ++out.seam_vertices;
    }
    for (auto& t : mesh_.triangles)
      for (std::uint32_t& v : t) v = stands_for_[v];
    std::erase_if(mesh_.triangles,
                  [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
    drop_doubled(mesh_);
    // Where a rim ends within its part there is no other part, and so no gap, and no seam.
    out.filled = fill_gaps(border_of(mesh_), part_of_, reach, mesh_);
    drop_dust(reach);
    for (const Side& side : border_of(mesh_))
      out.open_edges += part_of_[side.from] == kSeam || part_of_[side.to] == kSeam;
    number(out);
    return out;
  }

 private:
  /// Drops pieces within a few edges that end at their part's border: the part beside it has none
  /// of them.
  void drop_dust(double reach) {
    DisjointSets pieces(mesh_.positions.size());
    for (const auto& [a, b, c] : mesh_.triangles) pieces.unite(a, b), pieces.unite(b, c);
    struct Piece {
      bool open = false, goes_on = false;
      glm::vec3 low{std::numeric_limits<float>::max()}, high{std::numeric_limits<float>::lowest()};
    };
    std::vector<Piece> all(mesh_.positions.size());  // at the vertex that stands for each
    for (const auto& t : mesh_.triangles)
      for (const std::uint32_t v : t) {
        Piece& piece = all[pieces.root(v)];
        piece.low = glm::min(piece.low, mesh_.positions[v]);
        piece.high = glm::max(piece.high, mesh_.positions[v]);
      }
    for (const Side& side : border_of(mesh_)) {
      // Where the rim was cut off its part, it is two triangles from the border.
      const bool cut = !on_border_[side.from] && !on_border_[side.to];
      Piece& piece = all[pieces.root(side.from)];
      (cut ? piece.goes_on : piece.open) = true;
    }
    std::erase_if(mesh_.triangles, [&](const auto& t) {
      const Piece& piece = all[pieces.root(t[0])];
      return piece.open && !piece.goes_on &&
             double(glm::distance(piece.low, piece.high)) <= kLargestDust * reach;
    });
  }

  /// Says what becomes of the parts.
  void number(Stitched& out) {
    std::vector<bool> used(mesh_.positions.size(), false);
    for (const auto& t : mesh_.triangles)
      for (const std::uint32_t v : t) used[v] = true;
    std::vector<std::uint32_t> numbers(mesh_.positions.size());  // in the joined mesh
    for (std::size_t i = 0; i < rims_.size(); ++i) {
      Rim& rim = rims_[i];
      StitchedPart part;
      part.first = std::uint32_t(out.vertices);
      part.places.origin = mesh_.origin;
      for (std::uint32_t k = 0; k < rim.vertices.size(); ++k) {
        const std::uint32_t v = first_[i] + k;
        numbers[v] = part.first + rim.vertices[k] - std::uint32_t(part.gone.size());
        if (!used[v]) {
          part.gone.push_back(rim.vertices[k]);
        } else if (part_of_[v] == kSeam) {
          part.moved.push_back(rim.vertices[k]);
          add_vertex(mesh_, v, part.places);
        }
      }
      out.vertices += rim.part_vertices - part.gone.size();
      out.triangles += rim.part_triangles - rim.triangles.size();
      part.rim = std::move(rim.triangles);
      out.parts.push_back(std::move(part));
    }
    out.triangles += mesh_.triangles.size();
    out.rim = std::move(mesh_.triangles);
    for (auto& t : out.rim)
      for (std::uint32_t& v : t) v = numbers[v];
  }

  std::vector<Rim> rims_;
  TriMesh mesh_;
  std::vector<std::uint32_t> first_;  // of each rim, in mesh_
  std::vector<BorderVertex> border_;
  std::vector<bool> on_border_;         // of each vertex
  std::vector<std::uint32_t> part_of_;  // of each vertex
  std::vector<std::uint32_t> stands_for_;
};

/// Leaves out what is listed, which is in order.
template <typename T>
void leave_out(const std::vector<std::uint32_t>& listed, std::vector<T>& values) {
  if (values.empty()) return;
  std::size_t next = 0, kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (next < listed.size() && listed[next] == i)
      ++next;
    else
      values[kept++] = values[i];
  }
  values.resize(kept);
}

}  // namespace

Rim rim_of(const TriMesh& part) {
  const std::size_t count = part.positions.size();
  std::vector<bool> border(count, false), near(count, false), used(count, false);
  for (const Side& side : border_of(part)) border[side.from] = border[side.to] = true;
  for (const auto& [a, b, c] : part.triangles)
    if (border[a] || border[b] || border[c]) near[a] = near[b] = near[c] = true;
  Rim rim;
  rim.part_vertices = std::uint32_t(count);
  rim.part_triangles = std::uint32_t(part.triangles.size());
  for (std::uint32_t t = 0; t < part.triangles.size(); ++t) {
    const auto& [a, b, c] = part.triangles[t];
    if (!near[a] && !near[b] && !near[c]) continue;
    rim.triangles.push_back(t);
    rim.mesh.triangles.push_back(part.triangles[t]);
    used[a] = used[b] = used[c] = true;
  }
  rim.mesh.origin = part.origin;
  std::vector<std::uint32_t> numbers(count, 0);
  for (std::uint32_t v = 0; v < count; ++v) {
    if (!used[v]) continue;
    numbers[v] = std::uint32_t(rim.vertices.size());
    rim.vertices.push_back(v);
    rim.border.push_back(border[v]);
    add_vertex(part, v, rim.mesh);
  }
  for (auto& t : rim.mesh.triangles)
    for (std::uint32_t& v : t) v = numbers[v];
  return rim;
}

Stitched stitch_rims(std::vector<Rim> rims, double reach) {
  PHOTOHULL_CHECK_OP(reach, >, 0.0);
  return Joining(std::move(rims)).join(reach);
}

TriMesh joined_part(const StitchedPart& part, TriMesh mesh) {
  for (std::size_t i = 0; i < part.moved.size(); ++i) {
    const std::uint32_t v = part.moved[i];
    mesh.positions[v] = glm::vec3(part.places.world(i) - mesh.origin);
    if (!part.places.normals.empty()) mesh.normals[v] = part.places.normals[i];
    if (!part.places.colours.empty()) mesh.colours[v] = part.places.colours[i];
    if (!part.places.confidence.empty()) mesh.confidence[v] = part.places.confidence[i];
  }
  std::vector<std::uint32_t> numbers(mesh.positions.size());
  std::uint32_t gone = 0;
  for (std::uint32_t v = 0; v < numbers.size(); ++v) {
    numbers[v] = part.first + v - gone;
    if (gone < part.gone.size() && part.gone[gone] == v) ++gone;
  }
  leave_out(part.gone, mesh.positions);
  leave_out(part.gone, mesh.normals);
  leave_out(part.gone, mesh.colours);
  leave_out(part.gone, mesh.confidence);
  leave_out(part.rim, mesh.triangles);
  for (auto& t : mesh.triangles)
    for (std::uint32_t& v : t) v = numbers[v];
  return mesh;
}

}  // namespace photohull
