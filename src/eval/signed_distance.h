// The signed distance to a triangle mesh.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "core/mesh.h"

namespace photohull {
class ClosestPoint;
}

namespace photohull::eval {

/// The distance from the nearest point of a mesh, positive where its faces look. The sign is that
/// of the pseudonormal at the nearest point [BaerentzenAanaes05]: the face's normal, the mean of
/// two on an edge, the angle-weighted mean at a vertex; so for a closed mesh it is negative inside.
/// Vertices at the same position count as one. Faces without area are no surface. Const calls may
/// run in parallel.
class SignedDistance {
 public:
  /// Throws Error when no face has an area, as ClosestPoint does otherwise.
  explicit SignedDistance(const TriMesh& mesh);
  ~SignedDistance();
  SignedDistance(SignedDistance&&) noexcept;
  SignedDistance& operator=(SignedDistance&&) noexcept;

  struct Value {
    double distance = 0;     ///< world units
    glm::dvec3 normal{0.0};  ///< unit pseudonormal at the nearest point; 0 where faces cancel
    std::uint32_t hint = 0;  ///< for the query of a neighbour
  };
  /// `hint` is that of a near query, or 0: it saves time and does not change the answer.
  Value at(const glm::dvec3& p, std::uint32_t hint = 0) const;

 private:
  std::unique_ptr<ClosestPoint> surface_;
  std::vector<std::array<std::uint32_t, 3>> corners_;   ///< joined vertices of each face
  std::vector<glm::vec3> face_normals_;                 ///< unit
  std::vector<std::array<glm::vec3, 3>> edge_normals_;  ///< from each corner to the next
  std::vector<glm::vec3> vertex_normals_;               ///< of joined vertices
};

}  // namespace photohull::eval
