// Dual contouring places a vertex where the planes of its surroundings meet [Ju02]. Here the planes
// are those of flanks fitted at a distance, for the distance field is rounded near edges, and each
// triangle belongs to one of them: the edges between triangles of different flanks are the crease.
#include "mesh/sharpen_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "mesh/crease_field.h"
#include "mesh/mesh_edges.h"

namespace photohull {
namespace {

using glm::dvec3;
using Index = std::uint32_t;

constexpr Index kNone = CreaseField::kNone;
constexpr double kTurned = 0.25;     // square of the distance that counts as much as a right angle
constexpr double kSameFlank = 0.95;  // cosine
constexpr double kMostMove = 1.75, kMostCornerMove = 3;  // lengths
constexpr double kFlat = 0.02;   // height of a triangle in its longest side, at least
constexpr double kFacing = 0.3;  // cosine between a triangle and its flank, at least

class Sharpener {
 public:
  Sharpener(const SharpenOptions& options, double voxel_size, double detail, TriMesh& mesh)
      : options_(options), unit_(detail), voxels_(detail / voxel_size), mesh_(mesh) {
    positions_.reserve(mesh.positions.size());
    for (const glm::vec3& p : mesh.positions) positions_.push_back(dvec3(p) / unit_);
    m_.positions = positions_, m_.normals = mesh.normals, m_.triangles = mesh.triangles;
    list_faces();
  }

  std::size_t run() {
    field_ = find_crease_field(m_, options_, voxels_);
    if (field_.empty()) return 0;
    assign_triangles();
    place();
    hold_back();
    return store();
  }

 private:
  void list_faces() {
    m_.first.assign(positions_.size() + 1, 0);
    for (const auto& t : m_.triangles)
      for (const Index v : t) ++m_.first[v + 1];
    for (std::size_t i = 0; i < positions_.size(); ++i) m_.first[i + 1] += m_.first[i];
    m_.faces.resize(m_.first.back());
    std::vector<Index> next(m_.first.begin(), m_.first.end() - 1);
    for (Index t = 0; t < m_.triangles.size(); ++t)
      for (const Index v : m_.triangles[t]) m_.faces[next[v]++] = t;
  }

  Corners corners_of(const std::vector<dvec3>& positions, Index face) const {
    const auto& t = m_.triangles[face];
    return {positions[t[0]], positions[t[1]], positions[t[2]]};
  }

  /// The flank that each triangle near a crease belongs to, by its place and how it faces, as its
  /// normal there.
  void assign_triangles() {
    flank_at_.assign(m_.triangles.size(), kNone);
    std::vector<Index> assigned;
    for (Index f = 0; f < m_.triangles.size(); ++f) {
      const Corners p = corners_of(positions_, f);
      const dvec3 middle = (p[0] + p[1] + p[2]) / 3.0, facing = unit_normal(p);
      Index host = kNone;
      double least = std::numeric_limits<double>::max();
      for (const Index v : m_.triangles[f]) {
        const Index h = field_.host_of(v);
        if (h == kNone) continue;
        const double apart = glm::distance(positions_[field_.list[h]], middle);
        if (apart < least) least = apart, host = h;
      }
      if (host == kNone) continue;
      const dvec3 at = middle - positions_[field_.list[host]];
      double best = std::numeric_limits<double>::max();
      dvec3 chosen(0);
      for (int k = 0; k < field_.crease_at(host).flanks; ++k) {
        const Flank& flank = field_.crease_at(host).flank[k];
        const double distance = flank.distance(at);
        const dvec3 normal = flank.normal(at);
        const double cost = distance * distance + kTurned * (1 - glm::dot(facing, normal));
        if (cost < best) best = cost, chosen = normal;
      }
      assigned.push_back(f);
      if (chosen != dvec3(0)) set_flank(f, chosen);
    }
    for (int pass = 0; pass < 3; ++pass)
      for (const Index f : assigned) join_neighbours(f);
  }

  bool assigned(Index face) const { return flank_at_[face] != kNone; }
  const dvec3& flank(Index face) const { return flanks_[flank_at_[face]]; }

  Index across(Index face, int side) const {
    const Index a = m_.triangles[face][side], b = m_.triangles[face][(side + 1) % 3];
    for (const Index f : m_.around(a))
      if (f != face && std::count(m_.triangles[f].begin(), m_.triangles[f].end(), b)) return f;
    return kNone;
  }

  void set_flank(Index face, const dvec3& normal) {
    if (!assigned(face)) {
      flank_at_[face] = Index(flanks_.size());
      flanks_.emplace_back();
    }
    flanks_[flank_at_[face]] = normal;
  }

  /// A triangle with two neighbours of another flank joins them: the crease would double back.
  void join_neighbours(Index face) {
    std::array<Index, 3> others{};
    int count = 0;
    const dvec3 own = assigned(face) ? flank(face) : dvec3(0);
    for (int side = 0; side < 3; ++side) {
      const Index f = across(face, side);
      if (f != kNone && assigned(f) && glm::dot(flank(f), own) < kSameFlank) others[count++] = f;
    }
    for (int i = 1; i < count; ++i)
      for (int j = 0; j < i; ++j)
        if (glm::dot(flank(others[i]), flank(others[j])) > kSameFlank) {
          set_flank(face, flank(others[j]));
          return;
        }
  }

  /// Moves vertices by the least that brings them onto the flanks of all triangles around.
  void place() {
    placed_ = positions_;
    for (Index k = 0; k < field_.list.size(); ++k) {
      if (field_.host[k] == kNone) continue;
      const Crease& crease = field_.crease_at(field_.host[k]);
      const Index vertex = field_.list[k];
      std::array<const Flank*, 3> flanks{};
      int count = 0;
      for (int s = 0; s < crease.flanks; ++s)
        if (touches(vertex, crease, s)) flanks[count++] = &crease.flank[s];
      const dvec3 start = positions_[vertex] - positions_[field_.list[field_.host[k]]];
      const dvec3 move = meeting_point(std::span(flanks.data(), std::size_t(count)), start) - start;
      if (glm::length(move) <= (count == 3 ? kMostCornerMove : kMostMove)) placed_[vertex] += move;
    }
  }

  /// Does a triangle around the vertex belong to flank s rather than to the others?
  bool touches(Index vertex, const Crease& crease, int s) const {
    const dvec3 at(0);
    for (const Index f : m_.around(vertex)) {
      if (!assigned(f)) continue;
      int best = 0;
      for (int k = 1; k < crease.flanks; ++k)
        if (glm::dot(flank(f), crease.flank[k].normal(at)) >
            glm::dot(flank(f), crease.flank[best].normal(at)))
          best = k;
      if (best == s) return true;
    }
    return false;
  }

  /// Is a triangle degenerate, turned away from its flank, or folded onto a neighbour?
  bool is_bad(Index face) const {
    const Corners p = corners_of(placed_, face);
    const dvec3 normal = unit_normal(p);
    const dvec3 wanted = assigned(face) ? flank(face) : unit_normal(corners_of(positions_, face));
    if (relative_height(p) < kFlat || glm::dot(normal, wanted) < kFacing) return true;
    for (int side = 0; side < 3; ++side) {
      const Index f = across(face, side);
      if (f != kNone && glm::dot(normal, unit_normal(corners_of(placed_, f))) < kFoldCosine)
        return true;
    }
    return false;
  }

  /// Brings vertices of bad triangles back, half way at first, until none is bad by a move.
  void hold_back() {
    std::vector<Index> touched;
    for (const Index v : field_.list)
      if (placed_[v] != positions_[v])
        touched.insert(touched.end(), m_.around(v).begin(), m_.around(v).end());
    for (int round = 0;; ++round) {
      std::sort(touched.begin(), touched.end());
      touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
      std::vector<Index> back;
      for (const Index f : touched) {
        const auto& t = m_.triangles[f];
        Index farthest = t[0];
        for (const Index v : t)
          if (glm::distance(placed_[v], positions_[v]) >
              glm::distance(placed_[farthest], positions_[farthest]))
            farthest = v;
        if (placed_[farthest] != positions_[farthest] && is_bad(f)) back.push_back(farthest);
      }
      if (back.empty()) return;
      std::sort(back.begin(), back.end());
      back.erase(std::unique(back.begin(), back.end()), back.end());
      touched.clear();
      for (const Index v : back) {
        placed_[v] = round < 3 ? 0.5 * (placed_[v] + positions_[v]) : positions_[v];
        for (const Index f : m_.around(v)) {
          touched.push_back(f);
          for (int side = 0; side < 3; ++side)
            if (const Index other = across(f, side); other != kNone) touched.push_back(other);
        }
      }
    }
  }

  std::size_t store() {
    std::size_t moved = 0;
    for (const Index v : field_.list) {
      if (placed_[v] == positions_[v]) continue;
      ++moved;
      dvec3 normal(0);
      for (const Index f : m_.around(v)) normal += double_area(corners_of(placed_, f));
      mesh_.positions[v] = glm::vec3(placed_[v] * unit_);
      if (glm::length(normal) > 0) mesh_.normals[v] = glm::vec3(glm::normalize(normal));
    }
    return moved;
  }

  const SharpenOptions& options_;
  double unit_, voxels_;  // of lengths: in the world, and in voxels
  TriMesh& mesh_;
  std::vector<dvec3> positions_, placed_;
  CreaseMesh m_;
  CreaseField field_;
  std::vector<Index> flank_at_;  // of the flank that a triangle belongs to, if any
  std::vector<dvec3> flanks_;    // their normals
};

}  // namespace

std::size_t sharpen_edges(const SharpenOptions& options, double voxel_size, double detail,
                          TriMesh& mesh) {
  options.validate();
  PHOTOHULL_CHECK(voxel_size > 0 && detail >= voxel_size && std::isfinite(detail));
  PHOTOHULL_CHECK_OP(mesh.normals.size(), ==, mesh.positions.size());
  return options.on ? Sharpener(options, voxel_size, detail, mesh).run() : 0;
}

}  // namespace photohull
