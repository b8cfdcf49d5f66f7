// Based on: H. Hoppe, T. DeRose, T. Duchamp, J. McDonald, W. Stuetzle, "Mesh optimization",
// SIGGRAPH 1993 [Hoppe93]: of its moves, the swap of edges.
#include "mesh/flip_edges.h"

#include <algorithm>
#include <unordered_map>
#include <utility>

#include "mesh/mesh_samples.h"

namespace photohull {
namespace {

constexpr int kMostSweeps = 3;
/// A flip must leave less than this of the squared distances ...
constexpr double kWorthIt = 0.9;
/// ... unless a triangle of less height, in its longest side, gets that much higher,
constexpr double kSliver = 0.1, kMended = 1.5;
/// and then squares may grow by that of this share of the limit.
constexpr double kMendingCost = 0.1;
constexpr double kLeastCosine = 0.5;  ///< of the new triangles' normals with the old ones' mean

using Flags = std::vector<std::uint8_t>;

constexpr std::uint32_t kNone = ~0u;

class Flips {
 public:
  /// Without a surface, by shapes alone.
  Flips(const ClosestPoint* surface, const BlockLimits& limits, double sliver,
        std::vector<FitPoint>& points, TriMesh& simple)
      : surface_(surface), limits_(limits), sliver_(sliver), points_(points), mesh_(simple) {
    sides_.reserve(3 * mesh_.triangles.size());
    for (const Side& side : sorted_sides(mesh_.triangles)) {
      const auto [entry, is_new] = sides_.emplace(key(side.from, side.to), side.triangle);
      if (!is_new) entry->second = kNone;
    }
    changed_.assign(mesh_.triangles.size(), 1);
    points_of_.resize(mesh_.triangles.size());
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
      const std::uint32_t t = points_[i].triangle;
      points_of_[t].push_back(i);
      squared_.push_back(
          closest_on_triangle(points_[i].position, corners(mesh_, t)).squared_distance);
    }
  }

  /// Tries each edge of triangles that changed in the last sweep, all in the first; true when some
  /// were flipped.
  bool sweep() {
    const Flags changed = std::exchange(changed_, Flags(changed_.size()));
    bool any = false;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      for (int i = 0; i < 3 && changed[t]; ++i) {
        Flip flip;
        if (!find(t, i, flip)) continue;
        if (changed[flip.second] && flip.a > flip.b) continue;  // from the other side
        if (!is_sound(flip) || !is_worth_it(flip) || !is_near(flip)) continue;
        perform(flip);
        any = true;
        break;
      }
    return any;
  }

 private:
  /// Triangles (a, b, c) and (b, a, d) become (c, a, d) and (d, b, c).
  struct Flip {
    std::uint32_t first, second;  ///< triangles
    std::uint32_t a, b, c, d;     ///< vertices
    std::array<Corners, 2> before, after;
  };

  static std::uint64_t key(std::uint64_t from, std::uint64_t to) { return from << 32 | to; }

  /// The triangle with this side, kNone where there is none or several have it.
  std::uint32_t triangle_at(std::uint32_t from, std::uint32_t to) const {
    const auto entry = sides_.find(key(from, to));
    return entry == sides_.end() ? kNone : entry->second;
  }

  bool find(std::uint32_t t, int i, Flip& flip) const {
    const auto& corner = mesh_.triangles[t];
    const std::uint32_t a = corner[i], b = corner[(i + 1) % 3], c = corner[(i + 2) % 3];
    const std::uint32_t second = triangle_at(b, a);
    if (second == kNone || triangle_at(a, b) != t) return false;
    std::uint32_t d = kNone;
    for (const std::uint32_t v : mesh_.triangles[second])
      if (v != a && v != b) d = v;
    if (c == d || d == kNone || sides_.contains(key(c, d)) || sides_.contains(key(d, c)))
      return false;
    const glm::dvec3 pa = mesh_.world(a), pb = mesh_.world(b), pc = mesh_.world(c),
                     pd = mesh_.world(d);
    flip = {t, second, a, b, c, d, {{{pa, pb, pc}, {pb, pa, pd}}}, {{{pc, pa, pd}, {pd, pb, pc}}}};
    return true;
  }

  bool is_sound(const Flip& flip) const {
    const double least = least_height(flip.after);
    if (least < kLeastHeight || least < std::min(sliver_, least_height(flip.before))) return false;
    const glm::dvec3 sum = double_area(flip.before[0]) + double_area(flip.before[1]);
    const std::array<glm::dvec3, 2> normals{unit_normal(flip.after[0]), unit_normal(flip.after[1])};
    for (const glm::dvec3& n : normals)
      if (!(glm::dot(n, sum) > kLeastCosine * glm::length(sum))) return false;
    const auto folds = [&](std::uint32_t from, std::uint32_t to, const glm::dvec3& normal) {
      const std::uint32_t t = triangle_at(from, to);
      return t != kNone && glm::dot(normal, unit_normal(corners(mesh_, t))) < kFoldCosine;
    };
    return !folds(flip.a, flip.c, normals[0]) && !folds(flip.d, flip.a, normals[0]) &&
           !folds(flip.b, flip.d, normals[1]) && !folds(flip.c, flip.b, normals[1]);
  }

  static double least_height(const std::array<Corners, 2>& triangles) {
    return std::min(relative_height(triangles[0]), relative_height(triangles[1]));
  }

  bool is_worth_it(const Flip& flip) const {
    double before = 0, after = 0, area = 0;
    const double most = limits_.error * limits_.error;
    for (const std::uint32_t t : {flip.first, flip.second})
      for (const std::uint32_t i : points_of_[t]) {
        const FitPoint& p = points_[i];
        const double squared =
            std::min(closest_on_triangle(p.position, flip.after[0]).squared_distance,
                     closest_on_triangle(p.position, flip.after[1]).squared_distance);
        if (squared > most) return false;
        before += p.area * squared_[i];
        after += p.area * squared;
        area += p.area;
      }
    if (after < kWorthIt * before) return true;
    const double height = least_height(flip.before);
    return height < sliver_ && least_height(flip.after) > kMended * height &&
           after <= before + area * most * kMendingCost * kMendingCost;
  }

  bool is_near(const Flip& flip) const {
    if (!surface_) return true;
    bool near = true;
    std::uint32_t hint = 0;
    const auto measure = [&](const glm::dvec3& p) {
      if (!near) return;
      const NearestPoint nearest = surface_->nearest(p, hint);
      hint = nearest.triangle;
      near = nearest.distance <= limits_.error;
    };
    for_edge_points(mesh_.world(flip.c), mesh_.world(flip.d), limits_.spacing, measure);
    for (const Corners& triangle : flip.after) for_points(triangle, limits_.spacing, measure);
    return near;
  }

  void perform(const Flip& flip) {
    const auto& [first, second, a, b, c, d, before, after] = flip;
    mesh_.triangles[first] = {c, a, d};
    mesh_.triangles[second] = {d, b, c};
    changed_[first] = changed_[second] = 1;
    sides_.erase(key(a, b));
    sides_.erase(key(b, a));
    sides_[key(a, d)] = sides_[key(d, c)] = first;
    sides_[key(b, c)] = sides_[key(c, d)] = second;
    std::vector<std::uint32_t> all = std::move(points_of_[first]);
    all.insert(all.end(), points_of_[second].begin(), points_of_[second].end());
    points_of_[first].clear();
    points_of_[second].clear();
    for (const std::uint32_t i : all) {
      const glm::dvec3& p = points_[i].position;
      const double to_first = closest_on_triangle(p, after[0]).squared_distance;
      const double to_second = closest_on_triangle(p, after[1]).squared_distance;
      points_[i].triangle = to_first <= to_second ? first : second;
      squared_[i] = std::min(to_first, to_second);
      points_of_[points_[i].triangle].push_back(i);
    }
  }

  const ClosestPoint* surface_;
  const BlockLimits limits_;
  double sliver_;
  std::vector<FitPoint>& points_;
  TriMesh& mesh_;
  std::unordered_map<std::uint64_t, std::uint32_t> sides_;
  std::vector<double> squared_;                        ///< distances of the points
  Flags changed_;                                      ///< triangles
  std::vector<std::vector<std::uint32_t>> points_of_;  ///< by triangle
};

}  // namespace

void flip_edges(const ClosestPoint& surface, const BlockLimits& limits,
                std::vector<FitPoint>& points, TriMesh& simple) {
  Flips flips(&surface, limits, kSliver, points, simple);
  for (int sweep = 0; sweep < kMostSweeps && flips.sweep(); ++sweep) {
  }
}

void flip_slivers(double height, TriMesh& mesh) {
  std::vector<FitPoint> none;
  Flips flips(nullptr, {}, height, none, mesh);
  for (int sweep = 0; sweep < kMostSweeps && flips.sweep(); ++sweep) {
  }
}

}  // namespace photohull
