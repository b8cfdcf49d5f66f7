#include "mesh/reduce_mesh.h"

#include <meshoptimizer.h>

#include <vector>

namespace photohull {

TriMesh reduce_mesh(const TriMesh& mesh, std::size_t triangles, MoreNumbers more) {
  if (mesh.triangles.size() <= triangles) return mesh;
  const unsigned* indices = mesh.triangles.front().data();
  const std::size_t count = 3 * mesh.triangles.size();
  constexpr float kAnyError = 1;  // of the mesh's size
  std::vector<unsigned> left(count);
  left.resize(meshopt_simplify(left.data(), indices, count, &mesh.positions[0].x,
                               mesh.positions.size(), sizeof(glm::vec3), 3 * triangles, kAnyError,
                               0, nullptr));
  TriMesh result = mesh;  // not before: the simplification takes several times its memory
  result.triangles.clear();
  for (std::size_t i = 0; i < left.size(); i += 3)
    result.triangles.push_back({left[i], left[i + 1], left[i + 2]});
  keep_used_vertices(result, more);
  return result;
}

}  // namespace photohull
