#include "refine/job.h"

#include <malloc.h>

#include <algorithm>
#include <utility>

#include "carving/fit_grid.h"
#include "refine/kernels/match_patches.h"
#include "render/surface_points.h"
#include "volume/cavities.h"
#include "volume/combine.h"

namespace photohull::refine {
namespace {

constexpr std::size_t kPart = std::size_t(1) << 19;  // surfels that are matched at once
constexpr std::size_t kManySurfels = std::size_t(1) << 18;

/// Voxels that are narrower than so many pixels are matched in larger photographs at all levels;
/// at the last one all are.
constexpr double kFewestPixels = 0.75;

/// Calls take(matcher, surfels, choices, indices) for parts of the vertices that are comparable,
/// and puts what it says of them into place.
template <typename Take>
Matches in_parts(const RefineJob& job, const GridSpec& grid, const TriMesh& mesh,
                 std::span<const ViewChoice> choices, int scores, const Take& take) {
  Matches all;
  all.scores.assign(mesh.positions.size() * std::size_t(scores), kNoScore);
  all.texture.assign(mesh.positions.size(), 1);
  const auto match_some = [&](const PatchMatcher& matcher, const HeldNumbers& numbers,
                              std::span<const std::uint32_t> indices) {
    std::vector<PatchSurfel> surfels;
    std::vector<ViewChoice> views;
    for (const std::uint32_t i : indices) {
      const render::SurfacePoint point = render::to_voxels(grid, mesh, i);
      surfels.push_back({point.position, point.normal});
      views.push_back(numbers.of(choices[i]));
    }
    const Matches part = take(matcher, surfels, views, indices);
    for (std::size_t k = 0; k < indices.size(); ++k) {
      all.texture[indices[k]] = part.texture[k];
      std::copy_n(part.scores.begin() + std::ptrdiff_t(k) * scores, scores,
                  all.scores.begin() + std::ptrdiff_t(indices[k]) * scores);
    }
    all.samples += part.samples;
  };
  const MatchingPhotographs matching = job.matching(grid);
  matching.for_each(choices, [&](const projtex::Photographs& photographs,
                                 std::span<const std::uint32_t> indices,
                                 const HeldNumbers& numbers) {
    const PatchMatcher matcher(
        job.context, photographs.images, projtex::to_grid(photographs.cameras, grid),
        patch_rules(job.options.match, photographs.noise_sigma), "refine_match_patches");
    for (std::size_t first = 0; first < indices.size(); first += kPart)
      match_some(matcher, numbers, indices.subspan(first, std::min(kPart, indices.size() - first)));
  });
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

MatchingPhotographs RefineJob::matching(const GridSpec& grid) const {
  const auto pixel = [&] { return carving::pixel_footprint(grid.bounds(), photographs.cameras); };
  if (larger && (grid.voxel_size == finest_voxel || grid.voxel_size < kFewestPixels * pixel()))
    return MatchingPhotographs(*larger);
  return {photographs.images, photographs.cameras, photographs.noise_sigma};
}

Matches match_vertices(const RefineJob& job, const GridSpec& grid, const TriMesh& mesh,
                       std::span<const glm::vec3> bends, std::span<const ViewChoice> choices,
                       const OffsetRange& range) {
  Matches all =
      in_parts(job, grid, mesh, choices, range.count,
               [&](const PatchMatcher& matcher, std::span<const PatchSurfel> surfels,
                   std::span<const ViewChoice> views, std::span<const std::uint32_t> indices) {
                 std::vector<glm::vec3> bent;
                 if (!bends.empty())
                   for (const std::uint32_t i : indices) bent.push_back(bends[i]);
                 return matcher.match(surfels, bent, views, range);
               });
  all.range = range;
  return all;
}

Matches vertex_textures(const RefineJob& job, const GridSpec& grid, const TriMesh& mesh,
                        std::span<const ViewChoice> choices) {
  return in_parts(job, grid, mesh, choices, 0,
                  [&](const PatchMatcher& matcher, std::span<const PatchSurfel> surfels,
                      std::span<const ViewChoice> views,
                      std::span<const std::uint32_t>) { return matcher.textures(surfels, views); });
}

}  // namespace photohull::refine
