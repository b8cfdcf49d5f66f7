#include "synth/field_mesh.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "volume/extract_mesh.h"

namespace photohull::synth {
namespace {

/// Distances of one brick, or nothing stored where they are all out of the band.
std::uint32_t sample_brick(const LatticeField& field, const GridSpec& grid, const glm::ivec3& brick,
                           float* distance) {
  float low = SparseVolume::kBand, high = -SparseVolume::kBand;
  for (int x = 0; x < kBrickEdge; ++x)
    for (int y = 0; y < kBrickEdge; ++y)
      for (int z = 0; z < kBrickEdge; ++z) {
        const glm::ivec3 local(x, y, z);
        const double f = field(brick * kBrickEdge + local);
        const float d =
            std::clamp(float(f / grid.voxel_size), -SparseVolume::kBand, SparseVolume::kBand);
        distance[voxel_offset(local)] = d;
        low = std::min(low, d), high = std::max(high, d);
      }
  if (low == SparseVolume::kBand) return SparseVolume::kOutside;
  if (high == -SparseVolume::kBand) return SparseVolume::kInside;
  return 0;
}

/// What a whole brick is known to be: SparseVolume::kOutside, kInside, or 0 where it is to be
/// sampled.
using BrickTest = std::function<std::uint32_t(const glm::ivec3& brick)>;

SparseVolume sample(const LatticeField& field, const GridSpec& grid, const BrickTest& known) {
  SparseVolume volume;
  volume.grid = grid;
  volume.table.assign(grid.brick_count(), SparseVolume::kOutside);
  std::vector<std::vector<float>> stored(grid.brick_count());
  tbb::parallel_for(0, grid.bricks.z, [&](int z) {
    std::vector<float> distance(kBrickVoxels);
    for (int y = 0; y < grid.bricks.y; ++y)
      for (int x = 0; x < grid.bricks.x; ++x) {
        const std::size_t i = grid.brick_index({x, y, z});
        volume.table[i] = known({x, y, z});
        if (volume.table[i] != 0) continue;
        volume.table[i] = sample_brick(field, grid, {x, y, z}, distance.data());
        if (volume.table[i] == 0) stored[i] = distance;
      }
  });
  for (int z = 0; z < grid.bricks.z; ++z)
    for (int y = 0; y < grid.bricks.y; ++y)
      for (int x = 0; x < grid.bricks.x; ++x) {
        const std::size_t i = grid.brick_index({x, y, z});
        if (stored[i].empty()) continue;
        volume.table[i] = std::uint32_t(volume.bricks.size());
        volume.bricks.push_back({x, y, z});
        volume.distance.insert(volume.distance.end(), stored[i].begin(), stored[i].end());
      }
  return volume;
}

glm::dvec3 gradient(const Field& field, const glm::dvec3& p, double step) {
  glm::dvec3 g;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 d(0);
    d[axis] = step;
    g[axis] = (field(p + d) - field(p - d)) / (2 * step);
  }
  return g;
}

/// Newton's method with the gradient of where the vertex was, which is near enough for all steps.
void project(const Field& field, double step, TriMesh& mesh) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.positions.size(), 1024),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        glm::dvec3 p = mesh.world(i);
                        const glm::dvec3 g = gradient(field, p, step);
                        const glm::dvec3 along = g / dot(g, g);
                        for (int round = 0; round < 3; ++round) p -= field(p) * along;
                        mesh.positions[i] = glm::vec3(p - mesh.origin);
                      }
                    });
}

TriMesh mesh_of_volume(const SparseVolume& volume, const Field& exact) {
  TriMesh mesh = extract_mesh(volume);
  project(exact, 1e-4 * volume.grid.voxel_size, mesh);
  mesh.normals.clear();
  return mesh;
}

}  // namespace

TriMesh mesh_of_field(const LatticeField& sampled, const Field& exact, const GridSpec& grid) {
  return mesh_of_volume(sample(sampled, grid, [](const glm::ivec3&) { return 0u; }), exact);
}

TriMesh mesh_of_distance(const Field& field, const GridSpec& grid) {
  const auto at = [&](const glm::dvec3& voxel) { return field(grid.world(voxel)); };
  // From a brick's middle to its outermost voxels, and then as far as distances are kept.
  const double middle = 0.5 * (kBrickEdge - 1);
  const double reach = (std::sqrt(3.0) * middle + SparseVolume::kBand) * grid.voxel_size;
  const auto known = [&](const glm::ivec3& brick) {
    const double f = at(glm::dvec3(brick * kBrickEdge) + middle);
    if (f > reach) return SparseVolume::kOutside;
    return f < -reach ? SparseVolume::kInside : 0u;
  };
  return mesh_of_volume(sample([&](const glm::ivec3& i) { return at(glm::dvec3(i)); }, grid, known),
                        field);
}

}  // namespace photohull::synth
