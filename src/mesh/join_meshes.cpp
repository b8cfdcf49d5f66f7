#include "mesh/join_meshes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/gtx/hash.hpp>
#include <unordered_set>

#include "core/error.h"

namespace photohull {
namespace {

template <typename T>
void append_attribute(const std::vector<T>& from, std::size_t before, std::vector<T>& to) {
  if (to.size() == before && !from.empty())
    to.insert(to.end(), from.begin(), from.end());
  else
    to.clear();
}

/// Cells of a lattice that hold vertices of a mesh.
class Cells {
 public:
  Cells(const TriMesh& mesh, double width) : width_(width) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) cells_.insert(cell(mesh.world(v)));
  }

  /// Does the cell of a point, or one around it, hold a vertex?
  bool near(const glm::dvec3& p) const {
    const glm::ivec3 middle = cell(p);
    for (int z = -1; z <= 1; ++z)
      for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x)
          if (cells_.contains(middle + glm::ivec3(x, y, z))) return true;
    return false;
  }

 private:
  glm::ivec3 cell(const glm::dvec3& p) const { return glm::ivec3(glm::floor(p / width_)); }

  double width_;
  std::unordered_set<glm::ivec3> cells_;
};

}  // namespace

void append_mesh(const TriMesh& from, TriMesh& to) {
  if (from.positions.empty()) return;
  if (to.positions.empty()) {
    to = from;
    return;
  }
  const std::size_t before = to.positions.size();
  const glm::vec3 shift(from.origin - to.origin);
  append_attribute(from.normals, before, to.normals);
  append_attribute(from.colours, before, to.colours);
  append_attribute(from.confidence, before, to.confidence);
  to.positions.reserve(before + from.positions.size());
  for (const glm::vec3& p : from.positions) to.positions.push_back(p + shift);
  to.triangles.reserve(to.triangles.size() + from.triangles.size());
  const auto first = std::uint32_t(before);
  for (const auto& [a, b, c] : from.triangles)
    to.triangles.push_back({a + first, b + first, c + first});
}

void leave_out_covered(const TriMesh& fine, double reach, TriMesh& coarse, MoreNumbers more) {
  PHOTOHULL_CHECK_OP(reach, >, 0.0);
  const Cells cells(fine, reach / 1.5);  // the cells around a point's own reach one to two widths
  std::vector<bool> covered(coarse.positions.size());
  for (std::size_t v = 0; v < covered.size(); ++v) covered[v] = cells.near(coarse.world(v));
  std::erase_if(coarse.triangles,
                [&](const auto& t) { return covered[t[0]] && covered[t[1]] && covered[t[2]]; });
  keep_used_vertices(coarse, more);
}

}  // namespace photohull
