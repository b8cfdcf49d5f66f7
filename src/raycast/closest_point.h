// Nearest points of triangle meshes.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <memory>

#include "core/mesh.h"

namespace photohull {

/// The point of a triangle (a, b, c) nearest to another: weights.x a + weights.y b + weights.z c.
/// Weights are in [0, 1] and sum to 1; exact zeros tell where it lies: none in the face, one on the
/// edge between the other two corners, two at a corner.
struct TrianglePoint {
  glm::dvec3 point{0.0};
  glm::dvec3 weights{1, 0, 0};
  double squared_distance = std::numeric_limits<double>::infinity();
};

/// Nearest point to `p` of the triangle, which may be a segment or a point. Always a convex
/// combination of the corners, so that slivers cannot pull it off the triangle.
TrianglePoint closest_on_triangle(const glm::dvec3& p, const std::array<glm::dvec3, 3>& triangle);

/// The point of a mesh nearest to a query, in world coordinates.
struct NearestPoint {
  double distance = 0;
  glm::dvec3 point{0.0};
  glm::dvec3 weights{1, 0, 0};  ///< in `triangle`, as in TrianglePoint
  std::uint32_t triangle = 0;   ///< index into TriMesh::triangles; the lowest of equally near ones
};

/// A mesh ready for queries of nearest points; keeps no reference to it. The tree is Embree's, in
/// single precision with room for its rounding; distances are computed in double from the mesh's
/// own coordinates, so they are exact to rounding. Answers are the same in every run and from every
/// number of threads; const calls may run in parallel.
class ClosestPoint {
 public:
  /// Throws Error when the mesh has no triangle, a coordinate that is not finite, or does not fit
  /// into memory. Indices must be in range. Triangles may be degenerate.
  explicit ClosestPoint(const TriMesh& mesh);
  ~ClosestPoint();
  ClosestPoint(ClosestPoint&&) noexcept;
  ClosestPoint& operator=(ClosestPoint&&) noexcept;

  /// `p` must be finite and nearer than 1e18 to the mesh's origin. `hint` is a triangle that may be
  /// near, such as the answer to a neighbour of p: a good one saves time, none changes the answer.
  NearestPoint nearest(const glm::dvec3& p, std::uint32_t hint = 0) const;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace photohull
