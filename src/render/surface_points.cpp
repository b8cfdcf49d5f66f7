#include "render/surface_points.h"

#include <algorithm>
#include <cmath>

#include "shared/bake.h"

namespace photohull::render {
namespace {

/// Far more than a grid's edge: a triangle of nonsense must not stall the program.
constexpr int kMaxSteps = 4096;

/// Points of a regular subdivision of a triangle.
void subdivide(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, int steps,
               std::vector<SurfacePoint>& out) {
  const glm::vec3 ab = (b - a) / float(steps), ac = (c - a) / float(steps);
  const glm::vec3 normal = glm::cross(b - a, c - a);  // the kernel needs its direction only
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const bool corner = (i == 0 && j == 0) || i == steps || j == steps;
      if (!corner) out.push_back({a + float(i) * ab + float(j) * ac, normal});
    }
}

}  // namespace

SurfacePoint to_voxels(const GridSpec& grid, const TriMesh& mesh, std::size_t vertex) {
  const glm::dvec3 offset = (mesh.origin - grid.origin) / grid.voxel_size;
  const double scale = 1.0 / grid.voxel_size;
  return {glm::vec3(scale * glm::dvec3(mesh.positions[vertex]) + offset), mesh.normals[vertex]};
}

std::vector<SurfacePoint> to_voxels(const GridSpec& grid, const TriMesh& mesh) {
  std::vector<SurfacePoint> out(mesh.positions.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = to_voxels(grid, mesh, i);
  return out;
}

std::vector<SurfacePoint> points_between(const TriMesh& mesh,
                                         std::span<const SurfacePoint> vertices) {
  std::vector<SurfacePoint> points;
  constexpr float kSquare = float(kPointSpacing * kPointSpacing);
  for (const auto& t : mesh.triangles) {
    const glm::vec3 a = vertices[t[0]].position;
    const glm::vec3 b = vertices[t[1]].position;
    const glm::vec3 c = vertices[t[2]].position;
    const glm::vec3 ab = b - a, ac = c - a, bc = c - b;
    const float longest = std::max({glm::dot(ab, ab), glm::dot(ac, ac), glm::dot(bc, bc)});
    if (!(longest > kSquare)) continue;
    const double steps = std::min(std::ceil(std::sqrt(double(longest))), double(kMaxSteps));
    subdivide(a, b, c, int(steps), points);
  }
  return points;
}

visibility::DepthMaps occluder_maps(std::span<const Camera> cameras, const GridSpec& grid,
                                    int cut_at) {
  // DepthMaps sizes its texels after voxels: show it larger ones.
  GridSpec coarse = grid;
  coarse.voxel_size *= shaders::kBakeTexel;
  coarse.bricks = glm::max(grid.bricks / int(shaders::kBakeTexel), 1);
  coarse.before /= double(shaders::kBakeTexel);
  coarse.after /= double(shaders::kBakeTexel);
  return visibility::DepthMaps(projtex::to_grid(cameras, coarse), coarse, cut_at);
}

}  // namespace photohull::render
