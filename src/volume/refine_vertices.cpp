// Vertices onto the surface, and their normals, from the distance and its gradient.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/error.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

/// A distance's gradient has length 1. Where it is much shorter, opposite sides cancel and its
/// direction says little; where it is far from 1, a step by its length would not meet the surface.
constexpr float kLeastGradient = 0.2f;
constexpr float kTrustedGradient[2] = {0.7f, 1.4f};
constexpr float kLongestStep = 0.25f;  // voxels; dual vertices of a distance are nearer than that

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

/// Distances at the 4^3 voxels around a cell, x slowest.
using Neighbourhood = float[4][4][4];

/// Distance (voxels) and its gradient at a point.
struct Sample {
  float distance = 0;
  glm::vec3 gradient{0};
};

/// The values of a brick of the table, kBrickVoxels of them whether it is stored or not.
const float* brick_values(const SparseVolume& volume, const glm::ivec3& brick) {
  using Brick = std::array<float, kBrickVoxels>;
  const auto filled = [](float value) {
    Brick all;
    all.fill(value);
    return all;
  };
  static const Brick inside = filled(-SparseVolume::kBand), outside = filled(SparseVolume::kBand);
  const std::uint32_t slot = volume.table[volume.grid.brick_index(brick)];
  if (slot == SparseVolume::kInside) return inside.data();
  if (slot == SparseVolume::kOutside) return outside.data();
  return volume.distance.data() + std::size_t(slot) * kBrickVoxels;
}

/// Copies the 4^3 voxels from `low` on, which lie in at most two bricks along each axis. False when
/// a part of them is outside the grid: distances there are made up.
bool gather(const SparseVolume& volume, const glm::ivec3& low, Neighbourhood& out) {
  const glm::ivec3 high = low + 3;
  if (glm::any(glm::lessThan(low, glm::ivec3(0))) ||
      glm::any(glm::greaterThanEqual(high, volume.grid.voxels())))
    return false;
  const glm::ivec3 first = low / kBrickEdge, last = high / kBrickEdge;
  for (int bx = first.x; bx <= last.x; ++bx)
    for (int by = first.y; by <= last.y; ++by)
      for (int bz = first.z; bz <= last.z; ++bz) {
        const glm::ivec3 corner = glm::ivec3(bx, by, bz) * kBrickEdge;
        const float* values = brick_values(volume, {bx, by, bz});
        const glm::ivec3 from = glm::max(low, corner);
        const glm::ivec3 to = glm::min(high, corner + kBrickEdge - 1);
        for (int x = from.x; x <= to.x; ++x)
          for (int y = from.y; y <= to.y; ++y)
            for (int z = from.z; z <= to.z; ++z)
              out[x - low.x][y - low.y][z - low.z] =
                  values[voxel_offset(glm::ivec3(x, y, z) - corner)];
      }
  return true;
}

/// Trilinear interpolation, at a point in [0, 1]^3 of the cell in the neighbourhood's middle, of
/// the distances at the cell's corners and of their central differences.
Sample interpolate(const Neighbourhood& d, const glm::vec3& at) {
  Sample sum;
  for (int x = 1; x <= 2; ++x)
    for (int y = 1; y <= 2; ++y)
      for (int z = 1; z <= 2; ++z) {
        const glm::vec3 difference(d[x + 1][y][z] - d[x - 1][y][z], d[x][y + 1][z] - d[x][y - 1][z],
                                   d[x][y][z + 1] - d[x][y][z - 1]);
        const float weight =
            (x == 2 ? at.x : 1 - at.x) * (y == 2 ? at.y : 1 - at.y) * (z == 2 ? at.z : 1 - at.z);
        sum.distance += weight * d[x][y][z];
        sum.gradient += weight * 0.5f * difference;
      }
  return sum;
}

/// The step, in voxels, from a point to the surface: one of Newton's along the gradient.
glm::vec3 step_to_surface(const Sample& sample, float steepness) {
  if (steepness < kTrustedGradient[0] || steepness > kTrustedGradient[1]) return glm::vec3(0);
  const float length = -sample.distance / steepness;
  return sample.gradient * (glm::clamp(length, -kLongestStep, kLongestStep) / steepness);
}

/// Moves a vertex (voxels) and returns its normal. `faces` is the sum of the normals around it.
glm::vec3 refine_vertex(const SparseVolume& volume, const glm::vec3& faces, glm::dvec3& voxel) {
  const float length = glm::length(faces);
  const glm::vec3 face = length > 0 ? faces / length : glm::vec3(0, 0, 1);
  const glm::dvec3 cell = glm::floor(voxel);
  Neighbourhood distances;
  if (!gather(volume, glm::ivec3(cell) - 1, distances)) return face;
  const Sample sample = interpolate(distances, glm::vec3(voxel - cell));
  const float steepness = glm::length(sample.gradient);
  if (steepness < kLeastGradient || (length > 0 && glm::dot(sample.gradient, face) <= 0))
    return face;
  voxel += glm::dvec3(step_to_surface(sample, steepness));
  return sample.gradient / steepness;
}

}  // namespace

void refine_vertices(const SparseVolume& volume, TriMesh& mesh) {
  PHOTOHULL_CHECK(volume.grid.voxel_size > 0 || mesh.positions.empty());
  std::vector<glm::vec3> normals = sum_face_normals(mesh);
  const double size = volume.grid.voxel_size;
  const glm::dvec3 shift = mesh.origin - volume.grid.origin;
  const tbb::blocked_range<std::size_t> vertices(0, normals.size(), 4096);
  tbb::parallel_for(vertices, [&](const auto& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      glm::dvec3 voxel = (glm::dvec3(mesh.positions[i]) + shift) / size;
      normals[i] = refine_vertex(volume, normals[i], voxel);
      mesh.positions[i] = glm::vec3(voxel * size - shift);
    }
  });
  mesh.normals = std::move(normals);
}

}  // namespace photohull
