#include "mesh/crease_field.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace photohull {
namespace {

using glm::dvec3;
using Index = std::uint32_t;
using Flags = std::vector<std::uint8_t>;

constexpr Index kNone = CreaseField::kNone;
constexpr double kEdge = 0.7;   // voxels: shorter edges do not make a surface bend more
constexpr double kMargin = 1;   // voxels around what bends, which is rounded too
constexpr double kSpacing = 2;  // voxels between the vertices at which creases are looked for
constexpr double kPool = 8;     // rounds of sharing what was found, times the detail in voxels
constexpr double kLeastKnown = 0.02;  // weight of the findings that reach a vertex
constexpr double kShare = 0.6;        // of an edge's places that must show it

class CreaseSearch {
 public:
  CreaseSearch(CreaseMesh& mesh, const SharpenOptions& options, double voxels)
      : m_(mesh), options_(options), voxels_(voxels) {}

  CreaseField run() {
    mark_rounded();
    find_creases();
    agree();
    drop_short();
    spread();
    return std::move(field_);
  }

 private:
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
    bent_.assign(m_.positions.size(), 0);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, bent_.size(), 4096), [&](const auto& r) {
      for (std::size_t i = r.begin(); i < r.end(); ++i)
        for_neighbours(Index(i), [&](Index j) {
          const double apart = glm::distance(m_.positions[i], m_.positions[j]);
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
    field_.rank.assign(m_.positions.size(), kNone);
    for (Index i = 0; i < field_.rank.size(); ++i)
      if (m_.rounded[i]) {
        field_.rank[i] = Index(field_.list.size());
        field_.list.push_back(i);
      }
  }

  /// Looks for creases at bent vertices some voxels apart.
  void find_creases() {
    Flags covered(field_.list.size(), 0);
    std::vector<Index> seeds, ring, next;
    for (Index k = 0; k < field_.list.size(); ++k) {
      if (covered[k] || !bent_[field_.list[k]]) continue;
      seeds.push_back(k);
      covered[k] = 1;
      ring.assign(1, field_.list[k]);
      for (int r = rings(kSpacing); r > 0; --r) {
        next.clear();
        for (const Index v : ring)
          for_neighbours(v, [&](Index j) {
            if (field_.rank[j] == kNone || covered[field_.rank[j]]) return;
            covered[field_.rank[j]] = 1;
            next.push_back(j);
          });
        ring.swap(next);
      }
    }
    field_.creases.resize(seeds.size());
    field_.index.assign(field_.list.size(), kNone);
    for (Index s = 0; s < seeds.size(); ++s) field_.index[seeds[s]] = s;
    tbb::enumerable_thread_specific<CreaseScratch> scratch;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, seeds.size(), 64), [&](const auto& r) {
      for (std::size_t s = r.begin(); s < r.end(); ++s)
        field_.creases[s] = find_crease(m_, field_.list[seeds[s]], options_, scratch.local());
    });
  }

  /// One place may err: findings are pooled with those of the surroundings, and surface counts as a
  /// crease where enough of them say so.
  void agree() {
    const std::size_t n = field_.list.size();
    std::vector<glm::vec2> pool(n), next(n);  // found; known
    for (std::size_t k = 0; k < n; ++k)
      pool[k] = {field_.crease_at(k).finding == Crease::Finding::kFound,
                 field_.crease_at(k).finding != Crease::Finding::kUnknown};
    for (int round = int(std::lround(kPool * voxels_)); round > 0; --round) {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, n, 4096), [&](const auto& r) {
        for (std::size_t k = r.begin(); k < r.end(); ++k) {
          glm::vec2 sum = pool[k];
          float count = 1;
          for_neighbours(field_.list[k], [&](Index j) {
            if (field_.rank[j] == kNone) return;
            sum += pool[field_.rank[j]];
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
    Flags done(field_.list.size(), 0);
    std::vector<Index> run;
    for (Index k = 0; k < field_.list.size(); ++k) {
      if (!sharp_[k] || done[k]) continue;
      run.assign(1, k);
      done[k] = 1;
      dvec3 low(std::numeric_limits<double>::max()), high = -low;
      for (std::size_t i = 0; i < run.size(); ++i) {
        const Index vertex = field_.list[run[i]];
        low = glm::min(low, m_.positions[vertex]), high = glm::max(high, m_.positions[vertex]);
        for_neighbours(vertex, [&](Index j) {
          const Index r = field_.rank[j];
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
    field_.host.assign(field_.list.size(), kNone);
    for (Index k = 0; k < field_.list.size(); ++k)
      if (sharp_[k] && field_.crease_at(k).flanks) field_.host[k] = k;
    for (int round = 3 + 2 * rings(kSpacing); round > 0; --round) {
      std::vector<Index> next = field_.host;
      for (Index k = 0; k < field_.list.size(); ++k) {
        if (!sharp_[k] || field_.host[k] == k) continue;
        const auto apart = [&](Index host) {
          const dvec3 d = m_.positions[field_.list[host]] - m_.positions[field_.list[k]];
          return glm::dot(d, d);
        };
        double least =
            field_.host[k] == kNone ? std::numeric_limits<double>::max() : apart(field_.host[k]);
        for_neighbours(field_.list[k], [&](Index j) {
          const Index host = field_.rank[j] == kNone ? kNone : field_.host[field_.rank[j]];
          if (host == kNone || !(apart(host) < least)) return;
          least = apart(host);
          next[k] = host;
        });
      }
      field_.host = std::move(next);
    }
  }

  CreaseMesh& m_;
  const SharpenOptions& options_;
  double voxels_;
  Flags bent_, sharp_;  // vertices; ranks
  CreaseField field_;
};

}  // namespace

const Crease& CreaseField::crease_at(std::size_t place) const {
  static const Crease kUnknown;
  return index[place] == kNone ? kUnknown : creases[index[place]];
}

bool CreaseField::empty() const {
  return std::all_of(host.begin(), host.end(), [](Index h) { return h == kNone; });
}

CreaseField find_crease_field(CreaseMesh& mesh, const SharpenOptions& options, double voxels) {
  return CreaseSearch(mesh, options, voxels).run();
}

}  // namespace photohull
