// Private to module texture: colours where no photograph is clear.
#pragma once

#include "core/mesh.h"
#include "raycast/closest_point.h"

namespace photohull::texture {

/// The colours of a mesh's vertices, between them too. It refers to the mesh.
class FillColour {
 public:
  explicit FillColour(const TriMesh& mesh) : mesh_(mesh), nearest_(mesh) {}

  /// Root of linear light at the mesh's point nearest to `point` (world). `hint` as ClosestPoint
  /// has it, and is set.
  glm::vec3 root(const glm::dvec3& point, std::uint32_t& hint) const;

 private:
  const TriMesh& mesh_;
  ClosestPoint nearest_;
};

}  // namespace photohull::texture
