#include "visibility/truth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace photohull::visibility {
namespace {

constexpr double kSamePlace = 3e-6;

bool in_view(const Camera& viewpoint, const glm::dvec3& p) {
  const auto pixel = viewpoint.project(p);
  return pixel && viewpoint.on_image(*pixel);
}

}  // namespace

std::vector<std::uint8_t> visible_by_rays(const RayScene& mesh, const Camera& viewpoint,
                                          std::span<const Sample> samples) {
  std::vector<Ray> rays;
  rays.reserve(samples.size());
  const glm::dvec3 eye = viewpoint.center();
  for (const Sample& s : samples) rays.push_back({eye, s.position - eye, 0, 1});
  std::vector<Hit> hits(rays.size());
  mesh.closest(rays, hits);
  std::vector<std::uint8_t> out(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i)
    out[i] = in_view(viewpoint, samples[i].position) &&
             (!hits[i] || hits[i].t > 1 - kSamePlace || hits[i].triangle == samples[i].id);
  return out;
}

VoxelRays::VoxelRays(const SparseVolume& volume)
    : grid_(volume.grid), table_(volume.table), words_(volume.bricks.size() * kBrickVoxels / 32) {
  for (std::size_t i = 0; i < volume.distance.size(); ++i)
    if (volume.distance[i] < 0) words_[i / 32] |= 1u << (i % 32);
}

bool VoxelRays::inside(const glm::ivec3& voxel) const {
  const std::uint32_t slot = table_[grid_.brick_index(voxel / kBrickEdge)];
  if (slot >= SparseVolume::kInside) return slot == SparseVolume::kInside;
  const int offset = voxel_offset(voxel % kBrickEdge);
  return words_[slot * (kBrickVoxels / 32) + std::size_t(offset / 32)] >> (offset % 32) & 1;
}

std::optional<double> VoxelRays::first(const glm::dvec3& origin, const glm::dvec3& direction,
                                       double end) const {
  // Voxel coordinates with corners at integers.
  const glm::dvec3 o = (origin - grid_.origin) / grid_.voxel_size + 0.5;
  const glm::dvec3 d = direction / grid_.voxel_size;
  const glm::ivec3 n = grid_.voxels();
  double t = 0, leave = end;
  for (int i = 0; i < 3; ++i) {
    if (d[i] == 0) {
      if (o[i] < 0 || o[i] > n[i]) return std::nullopt;
      continue;
    }
    const double a = -o[i] / d[i], b = (n[i] - o[i]) / d[i];
    t = std::max(t, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (t > leave) return std::nullopt;
  glm::ivec3 voxel = glm::clamp(glm::ivec3(glm::floor(o + t * d)), glm::ivec3(0), n - 1);
  while (t <= leave) {
    if (inside(voxel)) return t;
    // The wall through which the ray leaves this voxel, computed afresh: errors do not add up.
    double next = std::numeric_limits<double>::infinity();
    int axis = 0;
    for (int i = 0; i < 3; ++i) {
      if (d[i] == 0) continue;
      const double wall = (voxel[i] + (d[i] > 0) - o[i]) / d[i];
      if (wall < next) next = wall, axis = i;
    }
    t = std::max(t, next);
    voxel[axis] += d[axis] > 0 ? 1 : -1;
    if (voxel[axis] < 0 || voxel[axis] >= n[axis]) break;
  }
  return std::nullopt;
}

std::vector<std::uint8_t> visible_by_rays(const VoxelRays& volume, const GridSpec& grid,
                                          const Camera& viewpoint, std::span<const Sample> samples,
                                          double slack) {
  std::vector<std::uint8_t> out;
  const glm::dvec3 eye = viewpoint.center();
  for (const Sample& s : samples) {
    const glm::dvec3 ray = s.position - eye;
    const double end = 1 - slack * grid.voxel_size / std::max(glm::length(ray), 1e-300);
    out.push_back(in_view(viewpoint, s.position) && !volume.first(eye, ray, end));
  }
  return out;
}

}  // namespace photohull::visibility
