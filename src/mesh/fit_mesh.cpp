#include "mesh/fit_mesh.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "mesh/fit_vertices.h"
#include "mesh/flip_edges.h"
#include "mesh/mesh_samples.h"
#include "raycast/closest_point.h"

namespace photohull {
namespace {

using Flags = std::vector<std::uint8_t>;

/// Flips cost little to measure, and the vertices' moves come on top.
constexpr double kFlipShare = 0.8, kFlipSpacing = 0.5;
constexpr int kMostRings = 3;       // of triangles around one that is wrong
constexpr std::size_t kRun = 1024;  // items of a parallel task

/// Calls `use(item, hint)` for items 0 to count - 1; hints last for a run of them.
template <typename Use>
void in_runs(std::size_t count, Use&& use) {
  tbb::parallel_for(std::size_t(0), (count + kRun - 1) / kRun, [&](std::size_t run) {
    std::uint32_t hint = 0;
    for (std::size_t i = run * kRun; i < std::min(count, (run + 1) * kRun); ++i) use(i, hint);
  });
}

/// Vertices, each for a third of its triangles, and points of triangles so large that others are
/// between their corners. The middles of small triangles cut what is convex, so they do not count.
std::vector<FitPoint> points_of(const TriMesh& mesh, double spacing) {
  constexpr double kUnused = -1;
  std::vector<double> areas(mesh.positions.size(), kUnused);
  std::vector<FitPoint> points;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Corners triangle = corners(mesh, t);
    const double area = glm::length(double_area(triangle)) / 2;
    const bool is_large = longest_side(triangle) > 2 * spacing;
    for (const std::uint32_t v : mesh.triangles[t])
      areas[v] = std::max(areas[v], 0.0) + (is_large ? 0 : area / 3);
    if (!is_large) continue;
    const std::size_t first = points.size();
    for_points(triangle, spacing, [&](const glm::dvec3& p) { points.push_back({p, area, 0}); });
    for (std::size_t i = first; i < points.size(); ++i)
      points[i].area /= double(points.size() - first);
  }
  for (std::size_t v = 0; v < areas.size(); ++v)
    if (areas[v] != kUnused) points.push_back({mesh.world(v), areas[v], 0});
  return points;
}

Flags border_of(const TriMesh& mesh) {
  Flags border(mesh.positions.size());
  const std::vector<Side> sides = sorted_sides(mesh.triangles);
  for (const Side& side : sides)
    if (!opposite(sides, side)) border[side.from] = border[side.to] = 1;
  return border;
}

void assign(const TriMesh& simple, std::vector<FitPoint>& points) {
  const ClosestPoint surface(simple);
  in_runs(points.size(), [&](std::size_t i, std::uint32_t& hint) {
    points[i].triangle = hint = surface.nearest(points[i].position, hint).triangle;
  });
}

/// Checks a mesh of which vertices have moved.
class MovedMesh {
 public:
  MovedMesh(const ClosestPoint& surface, const BlockLimits& limits, std::vector<FitPoint>& points,
            const TriMesh& start, TriMesh& moved)
      : surface_(surface),
        limits_(limits),
        points_(points),
        start_(start),
        mesh_(moved),
        sides_(sorted_sides(moved.triangles)) {}

  /// Moves vertices back around what is wrong, farther when it stays wrong, until nothing is, or
  /// was so before: with all vertices around it back.
  void mend() {
    Flags changed(mesh_.positions.size(), 1);
    for (int rings = 0;; rings = std::min(2 * rings + 1, kMostRings)) {
      Flags wrong = find_wrong(changed);
      Flags unused(mesh_.triangles.size());
      mark_rings(mesh_.triangles, rings, wrong, unused);
      bool any = false, any_moved = false;
      for (std::size_t v = 0; v < wrong.size(); ++v) {
        if (!wrong[v]) continue;
        any = true;
        any_moved |= mesh_.positions[v] != start_.positions[v];
        mesh_.positions[v] = start_.positions[v];
      }
      if (!any || (!any_moved && rings == kMostRings)) return;
      changed = std::move(wrong);
    }
  }

 private:
  /// Marks vertices that are wrong, or whose triangles are, where a corner has changed.
  Flags find_wrong(const Flags& changed) {
    Flags wrong(mesh_.positions.size()), triangles(mesh_.triangles.size());
    const auto is_changed = [&](std::size_t t) {
      const auto& [a, b, c] = mesh_.triangles[t];
      return changed[a] || changed[b] || changed[c];
    };
    in_runs(mesh_.positions.size(), [&](std::size_t v, std::uint32_t& hint) {
      wrong[v] = changed[v] && is_far(mesh_.world(v), hint);
    });
    in_runs(mesh_.triangles.size(), [&](std::size_t t, std::uint32_t& hint) {
      if (is_changed(t)) triangles[t] = is_far(t, hint);
    });
    check_distance_from_surface(is_changed, triangles);
    check_shapes(is_changed, triangles);
    for (std::size_t t = 0; t < triangles.size(); ++t)
      if (triangles[t])
        for (const std::uint32_t v : mesh_.triangles[t]) wrong[v] = 1;
    return wrong;
  }

  bool is_far(const glm::dvec3& p, std::uint32_t& hint) const {
    const NearestPoint nearest = surface_.nearest(p, hint);
    hint = nearest.triangle;
    return nearest.distance > limits_.error;
  }

  /// By points between the corners; those on edges once for each edge (borders have not moved).
  bool is_far(std::size_t t, std::uint32_t& hint) const {
    bool far = false;
    const auto measure = [&](const glm::dvec3& p) { far = far || is_far(p, hint); };
    const Corners points = corners(mesh_, t);
    const auto& triangle = mesh_.triangles[t];
    for (int i = 0; i < 3; ++i)
      if (triangle[i] < triangle[(i + 1) % 3])
        for_edge_points(points[i], points[(i + 1) % 3], limits_.spacing, measure);
    for_points(points, limits_.spacing, measure);
    return far;
  }

  /// A point whose triangle has not changed is as near as it was, or nearer.
  template <typename IsChanged>
  void check_distance_from_surface(const IsChanged& is_changed, Flags& wrong) {
    const ClosestPoint moved(mesh_);
    Flags far(points_.size());
    in_runs(points_.size(), [&](std::size_t i, std::uint32_t& hint) {
      if (!is_changed(points_[i].triangle)) return;
      const NearestPoint nearest = moved.nearest(points_[i].position, hint);
      points_[i].triangle = hint = nearest.triangle;
      far[i] = nearest.distance > limits_.error;
    });
    for (std::size_t i = 0; i < far.size(); ++i)
      if (far[i]) wrong[points_[i].triangle] = 1;
  }

  template <typename IsChanged>
  void check_shapes(const IsChanged& is_changed, Flags& wrong) const {
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t)
      if (is_changed(t) && relative_height(corners(mesh_, t)) < kLeastHeight &&
          relative_height(corners(start_, t)) >= kLeastHeight)
        wrong[t] = 1;
    const auto is_folded = [](const TriMesh& mesh, std::size_t t, std::size_t u) {
      return glm::dot(unit_normal(corners(mesh, t)), unit_normal(corners(mesh, u))) < kFoldCosine;
    };
    for (const Side& side : sides_) {
      const Side* other = side.from < side.to ? opposite(sides_, side) : nullptr;
      if (!other || (!is_changed(side.triangle) && !is_changed(other->triangle))) continue;
      if (is_folded(mesh_, side.triangle, other->triangle) &&
          !is_folded(start_, side.triangle, other->triangle))
        wrong[side.triangle] = wrong[other->triangle] = 1;
    }
  }

  const ClosestPoint& surface_;
  const BlockLimits& limits_;
  std::vector<FitPoint>& points_;
  const TriMesh& start_;
  TriMesh& mesh_;
  const std::vector<Side> sides_;
};

}  // namespace

void fit_mesh(const TriMesh& mesh, const BlockLimits& limits, TriMesh& simple) {
  const ClosestPoint surface(mesh);
  std::vector<FitPoint> points = points_of(mesh, limits.spacing);
  assign(simple, points);
  flip_edges(surface, {kFlipShare * limits.error, kFlipSpacing * limits.spacing}, points, simple);
  const TriMesh start = simple;
  const std::vector<glm::dvec3> moves =
      fit_vertices(points, simple, border_of(simple), limits.error);
  for (std::size_t v = 0; v < moves.size(); ++v) simple.positions[v] += glm::vec3(moves[v]);
  MovedMesh(surface, limits, points, start, simple).mend();
}

}  // namespace photohull
