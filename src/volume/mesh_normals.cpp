// Vertex normals from the distance's gradient.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <vector>

#include "core/error.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

/// Normals of the faces around each vertex, summed with their areas as weights.
std::vector<glm::vec3> sum_face_normals(const TriMesh& mesh) {
  std::vector<glm::vec3> sums(mesh.positions.size(), glm::vec3(0));
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::vec3& corner = mesh.positions[a];
    const glm::vec3 area = glm::cross(mesh.positions[b] - corner, mesh.positions[c] - corner);
    sums[a] += area;
    sums[b] += area;
    sums[c] += area;
  }
  return sums;
}

/// Distances of the 4^3 voxels around a cell; x slowest. Its 64 lookups are the cost of a normal.
using Neighbourhood = float[4][4][4];

/// False when a part of the neighbourhood is outside the grid: distances there are made up.
bool gather(const SparseVolume& volume, const glm::ivec3& low, Neighbourhood& out) {
  const glm::ivec3 size = volume.grid.voxels();
  if (glm::any(glm::lessThan(low, glm::ivec3(0))) || glm::any(glm::greaterThan(low + 4, size)))
    return false;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 4; ++y)
      for (int z = 0; z < 4; ++z) out[x][y][z] = volume.at(low + glm::ivec3(x, y, z));
  return true;
}

/// Gradient at `at` in [0, 1]^3 of the cell in the neighbourhood's middle: central differences at
/// the cell's corners, interpolated linearly along each axis.
glm::vec3 gradient(const Neighbourhood& d, const glm::vec3& at) {
  glm::vec3 sum(0);
  for (int x = 1; x <= 2; ++x)
    for (int y = 1; y <= 2; ++y)
      for (int z = 1; z <= 2; ++z) {
        const glm::vec3 difference(d[x + 1][y][z] - d[x - 1][y][z], d[x][y + 1][z] - d[x][y - 1][z],
                                   d[x][y][z + 1] - d[x][y][z - 1]);
        const float weight =
            (x == 2 ? at.x : 1 - at.x) * (y == 2 ? at.y : 1 - at.y) * (z == 2 ? at.z : 1 - at.z);
        sum += weight * difference;
      }
  return 0.5f * sum;
}

glm::vec3 vertex_normal(const SparseVolume& volume, const glm::dvec3& voxel,
                        const glm::vec3& faces) {
  /// A distance's gradient has length 1; much less means opposite sides cancel.
  constexpr float kLeastGradient = 0.2f;
  const float length = glm::length(faces);
  const glm::vec3 face = length > 0 ? faces / length : glm::vec3(0, 0, 1);
  const glm::dvec3 cell = glm::floor(voxel);
  Neighbourhood distances;
  if (!gather(volume, glm::ivec3(cell) - 1, distances)) return face;
  const glm::vec3 g = gradient(distances, glm::vec3(voxel - cell));
  const float steepness = glm::length(g);
  if (steepness < kLeastGradient || (length > 0 && glm::dot(g, face) <= 0)) return face;
  return g / steepness;
}

}  // namespace

void compute_normals(const SparseVolume& volume, TriMesh& mesh) {
  PHOTOHULL_CHECK(volume.grid.voxel_size > 0 || mesh.positions.empty());
  std::vector<glm::vec3> normals = sum_face_normals(mesh);
  const glm::dvec3 shift = mesh.origin - volume.grid.origin;
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, normals.size(), 4096), [&](const auto& range) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          const glm::dvec3 voxel = (glm::dvec3(mesh.positions[i]) + shift) / volume.grid.voxel_size;
          normals[i] = vertex_normal(volume, voxel, normals[i]);
        }
      });
  mesh.normals = std::move(normals);
}

}  // namespace photohull
