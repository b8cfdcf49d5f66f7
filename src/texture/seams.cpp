#include "texture/seams.h"

#include <algorithm>

#include "texture/surface.h"

namespace photohull::texture {

std::vector<Seam> find_seams(const TriMesh& mesh,
                             const std::vector<std::array<std::uint32_t, 3>>& neighbours,
                             const std::vector<std::uint32_t>& plane_of_face) {
  std::vector<Seam> seams;
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t other = neighbours[f][i];
      if (other == kNoFace || other < f || plane_of_face[other] == plane_of_face[f]) continue;
      seams.push_back({{f, other}, {mesh.triangles[f][i], mesh.triangles[f][(i + 1) % 3]}});
    }
  return seams;
}

}  // namespace photohull::texture
