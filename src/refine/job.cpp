#include "refine/job.h"

#include <malloc.h>

#include <algorithm>
#include <utility>

#include "refine/kernels/match_patches.h"
#include "render/surface_points.h"
#include "volume/cavities.h"
#include "volume/combine.h"

namespace photohull::refine {
namespace {

constexpr std::size_t kPart = std::size_t(1) << 19;  // surfels that are matched at once
constexpr std::size_t kManySurfels = std::size_t(1) << 18;

std::vector<PatchSurfel> surfels_of(const GridSpec& grid, const TriMesh& mesh, std::size_t first,
                                    std::size_t count) {
  std::vector<PatchSurfel> out;
  out.reserve(count);
  for (const render::SurfacePoint& point : render::to_voxels(grid, mesh, first, count))
    out.push_back({point.position, point.normal});
  return out;
}

PatchMatcher matcher_of(const RefineJob& job, const GridSpec& grid) {
  return {job.context, job.photographs.images, projtex::to_grid(job.photographs.cameras, grid),
          patch_rules(job.options.match, job.photographs.noise_sigma), "refine_match_patches"};
}

/// What take(first, count) says of parts of the vertices.
template <typename Take>
Matches in_parts(const TriMesh& mesh, const Take& take) {
  const std::size_t total = mesh.positions.size();
  Matches all;
  for (std::size_t first = 0; first < total; first += kPart) {
    Matches part = take(first, std::min(kPart, total - first));
    if (first == 0) {
      const std::size_t counted = part.texture.size();
      all = std::move(part);
      all.scores.reserve(all.scores.size() / counted * total);
      all.texture.reserve(total);
      continue;
    }
    all.scores.insert(all.scores.end(), part.scores.begin(), part.scores.end());
    all.texture.insert(all.texture.end(), part.texture.begin(), part.texture.end());
    all.samples += part.samples;
  }
  return all;
}

}  // namespace

SparseVolume bounded(const SparseVolume& volume, const SparseVolume& hull) {
  SparseVolume out = intersection(volume, hull);
  fill_cavities(out);
  return out;
}

SparseVolume bounded(const RefineJob& job, const SparseVolume& volume, BoundingHull& hull) {
  if (!hull.bounds(volume)) hull = BoundingHull(job.hull_at(volume.grid));
  return bounded(volume, hull.volume());
}

std::vector<glm::vec3> voxel_positions(const GridSpec& grid, const TriMesh& mesh) {
  const glm::dvec3 offset = (mesh.origin - grid.origin) / grid.voxel_size;
  std::vector<glm::vec3> out;
  out.reserve(mesh.positions.size());
  for (const glm::vec3& p : mesh.positions)
    out.emplace_back(glm::dvec3(p) / grid.voxel_size + offset);
  return out;
}

void give_back(const TriMesh& mesh) {
  if (mesh.positions.size() >= kManySurfels) malloc_trim(0);
}

Matches match_vertices(const RefineJob& job, const GridSpec& grid, const TriMesh& mesh,
                       std::span<const glm::vec3> bends, std::span<const ViewChoice> choices,
                       const OffsetRange& range) {
  const PatchMatcher matcher = matcher_of(job, grid);
  Matches all = in_parts(mesh, [&](std::size_t first, std::size_t count) {
    return matcher.match(surfels_of(grid, mesh, first, count),
                         bends.empty() ? bends : bends.subspan(first, count),
                         choices.subspan(first, count), range);
  });
  all.range = range;
  return all;
}

Matches vertex_textures(const RefineJob& job, const GridSpec& grid, const TriMesh& mesh,
                        std::span<const ViewChoice> choices) {
  const PatchMatcher matcher = matcher_of(job, grid);
  return in_parts(mesh, [&](std::size_t first, std::size_t count) {
    return matcher.textures(surfels_of(grid, mesh, first, count), choices.subspan(first, count));
  });
}

}  // namespace photohull::refine
