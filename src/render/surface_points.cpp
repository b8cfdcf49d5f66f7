#include "render/surface_points.h"

#include <algorithm>
#include <cmath>

namespace photohull::render {
namespace {

/// Far more than a grid's edge: a triangle of nonsense must not stall the program.
constexpr int kMaxSteps = 4096;

/// Points of a regular subdivision of a triangle; its corners are left out.
void subdivide(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, int steps,
               std::vector<glm::ivec4>& out) {
  const glm::vec3 ab = (b - a) / float(steps), ac = (c - a) / float(steps);
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const bool corner = (i == 0 && j == 0) || i == steps || j == steps;
      if (!corner) out.emplace_back(glm::ivec3(glm::round(a + float(i) * ab + float(j) * ac)), 0);
    }
}

}  // namespace

std::vector<glm::ivec4> surface_points(const GridSpec& grid, const TriMesh& mesh) {
  std::vector<glm::vec3> voxels;
  voxels.reserve(mesh.positions.size());
  const glm::dvec3 offset = (mesh.origin - grid.origin) / grid.voxel_size;
  for (const glm::vec3& p : mesh.positions)
    voxels.emplace_back(glm::dvec3(p) / grid.voxel_size + offset);
  std::vector<glm::ivec4> points;
  points.reserve(voxels.size());
  for (const glm::vec3& v : voxels) points.emplace_back(glm::ivec3(glm::round(v)), 0);
  constexpr float kSquare = float(kPointSpacing * kPointSpacing);
  for (const auto& t : mesh.triangles) {
    const glm::vec3 &a = voxels[t[0]], &b = voxels[t[1]], &c = voxels[t[2]];
    const glm::vec3 ab = b - a, ac = c - a, bc = c - b;
    const float longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    if (!(longest > kSquare)) continue;
    const double steps = std::min(std::ceil(std::sqrt(double(longest))), double(kMaxSteps));
    subdivide(a, b, c, int(steps), points);
  }
  return points;
}

}  // namespace photohull::render
