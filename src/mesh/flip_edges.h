// Private to module mesh: edges of a simplified mesh flipped.
#pragma once

#include <vector>

#include "mesh/simplify_block.h"
#include "raycast/closest_point.h"

namespace photohull {

/// A point of the mesh that a simplified one stands for.
struct FitPoint {
  glm::dvec3 position{0.0};    ///< world
  double area = 0;             ///< of the surface that it stands for
  std::uint32_t triangle = 0;  ///< of the simplified mesh, about the nearest
};

/// Flips edges between two triangles of `simple` where that brings it nearer to `points`, in the
/// mean square, or mends a sliver at little cost, and updates the points' triangles. No point gets
/// farther from `simple`, and nothing of it from `surface`, than `limits` allows. Edges at a border
/// or of more than two triangles stay; no edge gets more than two, no triangle is folded.
void flip_edges(const ClosestPoint& surface, const BlockLimits& limits,
                std::vector<FitPoint>& points, TriMesh& simple);

/// Flips edges of triangles lower than `height`, in their longest side, where that makes them
/// higher and by the same rules, whatever the distance.
void flip_slivers(double height, TriMesh& mesh);

}  // namespace photohull
