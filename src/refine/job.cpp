#include "refine/job.h"

#include <malloc.h>

#include <algorithm>
#include <utility>

#include "carving/fit_grid.h"
#include "refine/match_surfels.h"
#include "refine/tile_tasks.h"
#include "render/surface_points.h"
#include "volume/cavities.h"
#include "volume/combine.h"

namespace photohull::refine {
namespace {

constexpr std::size_t kManySurfels = std::size_t(1) << 18;

/// Voxels that are narrower than so many pixels are matched in larger photographs at all levels;
/// at the last one all are.
constexpr double kFewestPixels = 0.75;

/// The mesh's vertices; `bends` as SurfelsAsked has them.
SurfelsAsked vertices(const GridSpec& grid, const TriMesh& mesh, std::span<const glm::vec3> bends,
                      std::span<const ViewChoice> choices) {
  const auto at = [&grid, &mesh](std::uint32_t i) {
    const render::SurfacePoint point = render::to_voxels(grid, mesh, i);
    return PatchSurfel{point.position, point.normal};
  };
  return {at, bends, choices};
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

bool RefineJob::matches_larger(const GridSpec& grid) const {
  const auto pixel = [&] { return carving::pixel_footprint(grid.bounds(), photographs.cameras); };
  return larger && (grid.voxel_size == finest_voxel || grid.voxel_size < kFewestPixels * pixel());
}

MatchingPhotographs RefineJob::matching(const GridSpec& grid) const {
  if (matches_larger(grid)) return MatchingPhotographs(*larger);
  return {photographs.images, photographs.cameras, photographs.noise_sigma};
}

Matches match_vertices(const RefineJob& job, const GridSpec& grid, const TriMesh& mesh,
                       std::span<const glm::vec3> bends, std::span<const ViewChoice> choices,
                       const OffsetRange& range) {
  return match_in_tiles(job, grid, vertices(grid, mesh, bends, choices),
                        {job.options.match, range, false});
}

Matches vertex_textures(const RefineJob& job, const GridSpec& grid, const TriMesh& mesh,
                        std::span<const ViewChoice> choices) {
  return match_in_tiles(job, grid, vertices(grid, mesh, {}, choices),
                        {job.options.match, {}, true});
}

}  // namespace photohull::refine
