// Dual contouring places a vertex where the planes of its surroundings meet [Ju02]. Here the planes
// are those of flanks fitted at a distance, for the distance field is rounded near edges, and each
// triangle belongs to one of them: the edges between triangles of different flanks are the crease.
#include "mesh/sharpen_edges.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "mesh/crease.h"
#include "mesh/mesh_edges.h"

namespace photohull {
namespace {

using glm::dvec3;
using Index = std::uint32_t;
using Flags = std::vector<std::uint8_t>;

constexpr Index kNone = ~Index(0);
constexpr double kEdge = 0.7;   // voxels: shorter edges do not make a surface bend more
constexpr double kMargin = 1;   // voxels around what bends, which is rounded too
constexpr double kSpacing = 2;  // voxels between the vertices at which creases are looked for
constexpr double kPool = 8;     // rounds of sharing what was found, times the detail in voxels
constexpr double kLeastKnown = 0.02;  // weight of the findings that reach a vertex
constexpr double kShare = 0.6;        // of an edge's places that must show it
constexpr double kTurned = 0.25;      // square of the distance that counts as much as a right angle
constexpr double kSameFlank = 0.95;   // cosine
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
    mark_rounded();
    find_creases();
    agree();
    drop_short();
    spread();
    if (std::all_of(host_.begin(), host_.end(), [](Index h) { return h == kNone; })) return 0;
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

  template <typename F>
  void for_neighbours(Index vertex, F&& f) const {  // twice each, where the mesh is closed
    for (const Index face : m_.around(vertex))
      for (const Index j : m_.triangles[face])
        if (j != vertex) f(j);
  }

  int rings(double voxels) const { return int(std::lround(std::max(voxels * voxels_, 1.0))); }

  /// Marks what bends, and a margin around it: `rounded` and the list of these vertices.
  void mark_rounded() {
    const double least = kEdge / voxels_;
    bent_.assign(positions_.size(), 0);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bent_.size(), 4096), [&](const auto& r) {
      for (std::size_t i = r.begin(); i < r.end(); ++i)
        for_neighbours(Index(i), [&](Index j) {
          const double apart = glm::distance(positions_[i], positions_[j]);
          const double turn = glm::distance(m_.normals[i], m_.normals[j]);
          if (turn > options_.bend * std::max(apart, least)) bent_[i] = 1;
        });
    });
    m_.rounded = bent_;
    for (int ring = rings(kMargin); ring > 0; --ring) {
      Flags next = m_.rounded;
      for (const auto& t : m_.triangles)
        if (m_.rounded[t[0]] | m_.rounded[t[1]] | m_.rounded[t[2]])
          next[t[0]] = next[t[1]] = next[t[2]] = 1;
      m_.rounded = std::move(next);
    }
    rank_.assign(positions_.size(), kNone);
    for (Index i = 0; i < rank_.size(); ++i)
      if (m_.rounded[i]) {
        rank_[i] = Index(list_.size());
        list_.push_back(i);
      }
  }

  /// Looks for creases at bent vertices some voxels apart.
  void find_creases() {
    Flags covered(list_.size(), 0);
    std::vector<Index> seeds, ring, next;
    for (Index k = 0; k < list_.size(); ++k) {
      if (covered[k] || !bent_[list_[k]]) continue;
      seeds.push_back(k);
      covered[k] = 1;
      ring.assign(1, list_[k]);
      for (int r = rings(kSpacing); r > 0; --r) {
        next.clear();
        for (const Index v : ring)
          for_neighbours(v, [&](Index j) {
            if (rank_[j] == kNone || covered[rank_[j]]) return;
            covered[rank_[j]] = 1;
            next.push_back(j);
          });
        ring.swap(next);
      }
    }
    creases_.resize(seeds.size());
    crease_at_.assign(list_.size(), kNone);
    for (Index s = 0; s < seeds.size(); ++s) crease_at_[seeds[s]] = s;
    tbb::enumerable_thread_specific<CreaseScratch> scratch;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, seeds.size(), 64), [&](const auto& r) {
      for (std::size_t s = r.begin(); s < r.end(); ++s)
        creases_[s] = find_crease(m_, list_[seeds[s]], options_, scratch.local());
    });
  }

  /// One place may err: findings are pooled with those of the surroundings, and surface counts as a
  /// crease where enough of them say so.
  void agree() {
    const std::size_t n = list_.size();
    std::vector<glm::vec2> pool(n), next(n);  // found; known
    for (std::size_t k = 0; k < n; ++k)
      pool[k] = {crease_at(k).finding == Crease::Finding::kFound,
                 crease_at(k).finding != Crease::Finding::kUnknown};
    for (int round = int(std::lround(kPool * voxels_)); round > 0; --round) {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 4096), [&](const auto& r) {
        for (std::size_t k = r.begin(); k < r.end(); ++k) {
          glm::vec2 sum = pool[k];
          float count = 1;
          for_neighbours(list_[k], [&](Index j) {
            if (rank_[j] == kNone) return;
            sum += pool[rank_[j]];
            ++count;
          });
          next[k] = sum / count;
        }
      });
      pool.swap(next);
    }
    sharp_.resize(n);
    for (std::size_t k = 0; k < n; ++k)
      sharp_[k] = pool[k].y > kLeastKnown && pool[k].x >= kShare * pool[k].y;
  }

  void drop_short() {
    Flags done(list_.size(), 0);
    std::vector<Index> run;
    for (Index k = 0; k < list_.size(); ++k) {
      if (!sharp_[k] || done[k]) continue;
      run.assign(1, k);
      done[k] = 1;
      dvec3 low(std::numeric_limits<double>::max()), high = -low;
      for (std::size_t i = 0; i < run.size(); ++i) {
        const Index vertex = list_[run[i]];
        low = glm::min(low, positions_[vertex]), high = glm::max(high, positions_[vertex]);
        for_neighbours(vertex, [&](Index j) {
          const Index r = rank_[j];
          if (r == kNone || !sharp_[r] || done[r]) return;
          done[r] = 1;
          run.push_back(r);
        });
      }
      if (glm::distance(low, high) < options_.shortest)
        for (const Index r : run) sharp_[r] = 0;
    }
  }

  /// Gives every vertex of a crease the flanks that were fitted nearest to it.
  void spread() {
    host_.assign(list_.size(), kNone);
    for (Index k = 0; k < list_.size(); ++k)
      if (sharp_[k] && crease_at(k).flanks) host_[k] = k;
    for (int round = 3 + 2 * rings(kSpacing); round > 0; --round) {
      std::vector<Index> next = host_;
      for (Index k = 0; k < list_.size(); ++k) {
        if (!sharp_[k] || host_[k] == k) continue;
        const auto apart = [&](Index host) {
          const dvec3 d = positions_[list_[host]] - positions_[list_[k]];
          return glm::dot(d, d);
        };
        double least = host_[k] == kNone ? std::numeric_limits<double>::max() : apart(host_[k]);
        for_neighbours(list_[k], [&](Index j) {
          const Index host = rank_[j] == kNone ? kNone : host_[rank_[j]];
          if (host == kNone || !(apart(host) < least)) return;
          least = apart(host);
          next[k] = host;
        });
      }
      host_ = std::move(next);
    }
  }

  /// Nothing is known where none was looked for.
  const Crease& crease_at(std::size_t rank) const {
    static const Crease kUnknown;
    return crease_at_[rank] == kNone ? kUnknown : creases_[crease_at_[rank]];
  }

  Index host_of(Index vertex) const {
    return rank_[vertex] == kNone ? kNone : host_[rank_[vertex]];
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
        const Index h = host_of(v);
        if (h == kNone) continue;
        const double apart = glm::distance(positions_[list_[h]], middle);
        if (apart < least) least = apart, host = h;
      }
      if (host == kNone) continue;
      const dvec3 at = middle - positions_[list_[host]];
      double best = std::numeric_limits<double>::max();
      dvec3 chosen(0);
      for (int k = 0; k < crease_at(host).flanks; ++k) {
        const Flank& flank = crease_at(host).flank[k];
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
    for (Index k = 0; k < list_.size(); ++k) {
      if (host_[k] == kNone) continue;
      const Crease& crease = crease_at(host_[k]);
      const Index vertex = list_[k];
      std::array<const Flank*, 3> flanks{};
      int count = 0;
      for (int s = 0; s < crease.flanks; ++s)
        if (touches(vertex, crease, s)) flanks[count++] = &crease.flank[s];
      const dvec3 start = positions_[vertex] - positions_[list_[host_[k]]];
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
    for (const Index v : list_)
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
    for (const Index v : list_) {
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
  Flags bent_, sharp_;            // vertices; ranks
  std::vector<Index> list_;       // the rounded vertices
  std::vector<Index> rank_;       // of a vertex in the list
  std::vector<Crease> creases_;   // where they were looked for
  std::vector<Index> crease_at_;  // a rank's
  std::vector<Index> host_;       // rank of the crease that holds at a rank
  std::vector<Index> flank_at_;   // of the flank that a triangle belongs to, if any
  std::vector<dvec3> flanks_;     // their normals
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
