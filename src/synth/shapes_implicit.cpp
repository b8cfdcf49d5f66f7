// Shapes that are the zero set of a function: meshed through a volume, and every vertex then moved
// onto the function's own zero.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "core/grid.h"
#include "synth/shape_makers.h"
#include "volume/extract_mesh.h"

namespace photohull::synth {
namespace {

using Field = std::function<double(const glm::dvec3&)>;

/// A field on the lattice's own points.
using LatticeField = std::function<double(const glm::ivec3& voxel)>;

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

SparseVolume sample(const LatticeField& field, const GridSpec& grid) {
  SparseVolume volume;
  volume.grid = grid;
  volume.table.assign(grid.brick_count(), SparseVolume::kOutside);
  std::vector<std::vector<float>> stored(grid.brick_count());
  tbb::parallel_for(0, grid.bricks.z, [&](int z) {
    std::vector<float> distance(kBrickVoxels);
    for (int y = 0; y < grid.bricks.y; ++y)
      for (int x = 0; x < grid.bricks.x; ++x) {
        const std::size_t i = grid.brick_index({x, y, z});
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

/// Newton's method along the gradient.
void project(const Field& field, double step, TriMesh& mesh) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, mesh.positions.size(), 1024),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        glm::dvec3 p = mesh.world(i);
                        for (int round = 0; round < 3; ++round) {
                          const glm::dvec3 g = gradient(field, p, step);
                          p -= field(p) / dot(g, g) * g;
                        }
                        mesh.positions[i] = glm::vec3(p - mesh.origin);
                      }
                    });
}

}  // namespace

namespace {

/// The gyroid's function from the sines and cosines of the three angles.
double gyroid(const glm::dvec3& s, const glm::dvec3& c, double distance, double k, double radius,
              double wall) {
  const double g = s.x * c.y + s.y * c.z + s.z * c.x;
  const double sheet = (g * g - wall * wall) / (2 * wall * 1.5 * k);
  const double ball = distance - radius;
  // The larger of the two, rounded where they meet.
  const double rounding = 0.04 * radius, apart = sheet - ball;
  return 0.5 * (sheet + ball + std::sqrt(apart * apart + rounding * rounding));
}

double wave_number(const ShapeValues& v) {
  return std::numbers::pi * v.at("cells") / v.at("radius");
}

}  // namespace

double gyroid_field(const glm::dvec3& p, const ShapeValues& v) {
  const double k = wave_number(v);
  return gyroid(sin(k * p), cos(k * p), length(p), k, v.at("radius"), v.at("thickness"));
}

TriMesh make_gyroid(const ShapeValues& v) {
  const double radius = v.at("radius"), wall = v.at("thickness"), k = wave_number(v);
  GridSpec grid;
  const int bricks = 24 + int(8 * v.at("cells"));
  grid.bricks = glm::ivec3(bricks);
  grid.voxel_size = 2.1 * radius / (bricks * kBrickEdge);
  grid.origin = -0.5 * grid.voxel_size * glm::dvec3(grid.voxels() - 1);
  // The lattice is a cube about the origin: one table serves all axes.
  std::vector<double> place, sine, cosine;
  for (int i = 0; i < bricks * kBrickEdge; ++i) {
    place.push_back(grid.origin.x + grid.voxel_size * i);
    sine.push_back(std::sin(k * place.back()));
    cosine.push_back(std::cos(k * place.back()));
  }
  const auto pick = [](const std::vector<double>& table, const glm::ivec3& i) {
    return glm::dvec3(table[i.x], table[i.y], table[i.z]);
  };
  const SparseVolume volume = sample(
      [&](const glm::ivec3& i) {
        return gyroid(pick(sine, i), pick(cosine, i), length(pick(place, i)), k, radius, wall);
      },
      grid);
  TriMesh mesh = extract_mesh(volume);
  project([&](const glm::dvec3& p) { return gyroid_field(p, v); }, 1e-4 * grid.voxel_size, mesh);
  mesh.normals.clear();
  return mesh;
}

}  // namespace photohull::synth
