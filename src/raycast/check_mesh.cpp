#include "raycast/check_mesh.h"

#include <cmath>

#include "core/error.h"

namespace photohull {

void check_mesh(const TriMesh& mesh) {
  if (mesh.triangles.empty()) throw Error("the mesh has no triangles; give one with faces");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const glm::vec3& p = mesh.positions[i];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
      throw Error(concat("vertex ", i, " of the mesh has a coordinate that is not finite"));
  }
}

}  // namespace photohull
