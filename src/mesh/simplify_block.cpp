// Edge collapse by quadrics (M. Garland, P. Heckbert, "Surface simplification using quadric error
// metrics", SIGGRAPH 1997 [GarlandHeckbert97]) in meshoptimizer, each result checked and mended.
#include "mesh/simplify_block.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <optional>

#include "mesh/flip_edges.h"
#include "mesh/mesh_edges.h"
#include "mesh/mesh_samples.h"
#include "mesh/simplify_mesh.h"
#include "raycast/closest_point.h"

namespace photohull {
namespace {

/// A quadric's error is a mean over planes: most points stay within twice of it. What does not
/// keeps its triangles and costs a round; when many do, the collapses aim lower.
constexpr double kQuadricShare = 0.7;
constexpr double kSliver = 0.02;  // height of triangles to mend, in their longest side
constexpr int kMostRounds = 24, kRoundsAtFullAim = 10;
constexpr double kLowerAim = 0.85;

using Flags = std::vector<std::uint8_t>;

/// Collapses edges of the triangles that are not kept; vertices that those share with others, or
/// that lie on a border, stay. Between such vertices in a row collapses leave triangles without
/// area, above all where the mesh is flat: flips mend them.
Triangles collapse(const TriMesh& block, const Flags& kept, double error) {
  std::vector<unsigned> indices;
  for (std::size_t t = 0; t < block.triangles.size(); ++t)
    if (!kept[t])
      indices.insert(indices.end(), block.triangles[t].begin(), block.triangles[t].end());
  if (indices.empty()) return {};
  const float* positions = &block.positions[0].x;
  const std::size_t count = block.positions.size();
  const float scale = meshopt_simplifyScale(positions, count, sizeof(glm::vec3));
  std::vector<unsigned> left(indices.size());
  left.resize(meshopt_simplify(left.data(), indices.data(), indices.size(), positions, count,
                               sizeof(glm::vec3), 0, float(error / scale),
                               meshopt_SimplifyLockBorder, nullptr));
  TriMesh result{block.positions, block.origin, {}, {}, {}, {}};
  for (std::size_t i = 0; i < left.size(); i += 3)
    result.triangles.push_back({left[i], left[i + 1], left[i + 2]});
  flip_slivers(kSliver, result);
  return std::move(result.triangles);
}

bool contains(const Triangles& sorted, const std::array<std::uint32_t, 3>& triangle) {
  return std::binary_search(sorted.begin(), sorted.end(), triangle);
}

/// What distances told so far; a triangle that comes again needs no new ones.
struct MeasuredBlock {
  Triangles near_block;  ///< sorted; all of their points are near the block
  /// For each triangle of the block, those of the result that its points are near.
  std::vector<Triangles> near_result;
};

/// Finds what is wrong with triangles in place of the block's, and marks the block's vertices
/// there. The first `loose` triangles are new, the others the block's own.
class Inspection {
 public:
  Inspection(const TriMesh& block, const ClosestPoint& surface, const BlockLimits& limits,
             const Triangles& triangles, std::size_t loose, MeasuredBlock& measured)
      : block_(block),
        surface_(surface),
        limits_(limits),
        loose_(loose),
        measured_(measured),
        result_{block.positions, block.origin, {}, {}, {}, triangles},
        faults_(block.positions.size()) {}

  /// Marks of the block's vertices; empty when nothing is wrong.
  Flags run(const Flags& kept) {
    if (result_.triangles.empty()) {  // something of a few voxels, folded away
      faults_.assign(faults_.size(), 1);
      return faults_;
    }
    check_shapes();
    check_edges();
    check_distance_to_block();
    check_distance_from_block(kept);
    return any_ ? faults_ : Flags();
  }

 private:
  void mark(const std::array<std::uint32_t, 3>& corners) {
    for (const std::uint32_t v : corners) faults_[v] = 1;
    any_ = true;
  }

  void check_shapes() {
    normals_.reserve(result_.triangles.size());
    for (std::size_t t = 0; t < result_.triangles.size(); ++t) {
      const Corners points = corners(result_, t);
      normals_.push_back(unit_normal(points));
      if (t < loose_ && relative_height(points) < kLeastHeight) mark(result_.triangles[t]);
    }
  }

  /// Every directed edge must occur once, and not between faces folded onto each other.
  void check_edges() {
    const std::vector<Side> sides = sorted_sides(result_.triangles);
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const Side& side = sides[i];
      const bool again = i > 0 && sides[i - 1].from == side.from && sides[i - 1].to == side.to;
      if (again && (side.triangle < loose_ || sides[i - 1].triangle < loose_)) {
        mark(result_.triangles[side.triangle]);
        mark(result_.triangles[sides[i - 1].triangle]);
      }
      if (side.from > side.to) continue;
      const Side* other = opposite(sides, side);
      if (!other) continue;
      if (side.triangle >= loose_ && other->triangle >= loose_) continue;
      if (glm::dot(normals_[side.triangle], normals_[other->triangle]) > kFoldCosine) continue;
      mark(result_.triangles[side.triangle]);
      mark(result_.triangles[other->triangle]);
    }
  }

  void check_distance_to_block() {
    Triangles near;
    std::uint32_t hint = 0;
    for (std::size_t t = 0; t < loose_; ++t) {
      const auto& triangle = result_.triangles[t];
      bool fails = false;
      if (!contains(measured_.near_block, triangle))
        for_points(corners(result_, t), limits_.spacing, [&](const glm::dvec3& p) {
          const NearestPoint nearest = surface_.nearest(p, hint);
          hint = nearest.triangle;
          if (nearest.distance <= limits_.error) return;
          mark(block_.triangles[nearest.triangle]);
          fails = true;
        });
      if (fails)
        mark(triangle);
      else
        near.push_back(triangle);
    }
    std::sort(near.begin(), near.end());
    measured_.near_block = std::move(near);
  }

  void check_distance_from_block(const Flags& kept) {
    Triangles present = result_.triangles;
    std::sort(present.begin(), present.end());
    Flags done(block_.positions.size());  // vertices of the result, and those already measured
    for (const auto& triangle : result_.triangles)
      for (const std::uint32_t v : triangle) done[v] = 1;
    const ClosestPoint result(result_);
    std::uint32_t hint = 0;
    for (std::size_t t = 0; t < block_.triangles.size(); ++t) {
      Triangles& near = measured_.near_result[t];
      const auto is_present = [&](const auto& triangle) { return contains(present, triangle); };
      if (kept[t] || (!near.empty() && std::all_of(near.begin(), near.end(), is_present))) continue;
      near.clear();
      bool fails = false;
      const auto measure = [&](const glm::dvec3& p) {
        const NearestPoint nearest = result.nearest(p, hint);
        hint = nearest.triangle;
        near.push_back(result_.triangles[hint]);
        fails |= nearest.distance > limits_.error;
      };
      // Between the corners of a small triangle there is no room for more points.
      for (const std::uint32_t v : block_.triangles[t])
        if (!done[v]) measure(block_.world(v));
      const auto points = corners(block_, t);
      if (longest_side(points) > 2 * limits_.spacing) for_points(points, limits_.spacing, measure);
      if (!fails) {
        for (const std::uint32_t v : block_.triangles[t]) done[v] = 1;
        continue;
      }
      mark(block_.triangles[t]);
      near.clear();
    }
  }

  const TriMesh& block_;
  const ClosestPoint& surface_;
  const BlockLimits& limits_;
  std::size_t loose_;
  MeasuredBlock& measured_;
  TriMesh result_;
  Flags faults_;
  std::vector<glm::dvec3> normals_;
  bool any_ = false;
};

}  // namespace

void mark_rings(const Triangles& triangles, int rings, Flags& vertices, Flags& marked) {
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<std::uint32_t> grown;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      const auto& [a, b, c] = triangles[t];
      if (!vertices[a] && !vertices[b] && !vertices[c]) continue;
      marked[t] = 1;
      grown.insert(grown.end(), {a, b, c});
    }
    for (const std::uint32_t v : grown) vertices[v] = 1;
  }
}

Triangles simplify_block(const TriMesh& block, const BlockLimits& limits, Flags& kept) {
  const ClosestPoint surface(block);
  MeasuredBlock measured{{}, std::vector<Triangles>(block.triangles.size())};
  double aim = kQuadricShare * limits.error;
  for (int round = 0; round < kMostRounds; ++round) {
    if (round >= kRoundsAtFullAim) aim *= kLowerAim;
    Triangles triangles = collapse(block, kept, aim);
    const std::size_t loose = triangles.size();
    for (std::size_t t = 0; t < kept.size(); ++t)
      if (kept[t]) triangles.push_back(block.triangles[t]);
    Flags faults = Inspection(block, surface, limits, triangles, loose, measured).run(kept);
    if (faults.empty()) return triangles;
    mark_rings(block.triangles, 1, faults, kept);
  }
  kept.assign(kept.size(), 1);
  return block.triangles;
}

}  // namespace photohull
