// Consistency of visibility: a surface that hides another from a view which shows it is not there
// [Merrell07].
#include "refine/look_through.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "refine/kernels/match_patches.h"
#include "refine/voxel_set.h"

namespace photohull::refine {
namespace {

using glm::ivec3;

constexpr float kFreed = 0.5f;        // distance of a voxel that was freed, voxels
constexpr double kLeastWeight = 0.5;  // of a surfel's peak: smooth shading agrees anywhere
constexpr int kLeastViews = 3;        // that a surfel was matched in
constexpr int kPasses = 3;            // of freeing what freed voxels outnumber

/// Where lines pass through the volume's inside: a voxel comes as often as lines do.
VoxelSet blocked(std::span<const Sightline> lines, std::span<const projtex::GridCamera> cameras,
                 const SparseVolume& volume) {
  const Lattice lattice(volume.grid);
  std::vector<VoxelSet> parts((lines.size() + kVoxelSetPart - 1) / kVoxelSetPart);
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t part) {
    for (std::size_t l = part * kVoxelSetPart;
         l < std::min(lines.size(), (part + 1) * kVoxelSetPart); ++l) {
      const glm::dvec3 from(lines[l].from);
      const glm::dvec3 way = cameras[std::size_t(lines[l].view)].centre - from;
      // A voxel a step along the longest axis, so that none comes twice.
      const int steps = int(std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)}));
      for (int i = 0; i < steps; ++i) {
        const ivec3 voxel = nearest_voxel(from + double(i) / steps * way);
        if (!lattice.contains(voxel)) break;
        if (volume.at(voxel) < 0) parts[part].push_back(lattice.index(voxel));
      }
    }
  });
  return sorted(parts);
}

/// Voxels beside `fresh` ones that are inside still and have more neighbours outside than inside.
std::vector<ivec3> outnumbered(const std::vector<ivec3>& fresh, const VoxelSet& kept,
                               const SparseVolume& volume) {
  const Lattice lattice(volume.grid);
  VoxelSet about;
  for (const ivec3& voxel : fresh)
    for_block(lattice, voxel, [&](const ivec3& v) {
      if (volume.at(v) < 0) about.push_back(lattice.index(v));
    });
  tbb::parallel_sort(about.begin(), about.end());
  about.erase(std::unique(about.begin(), about.end()), about.end());
  std::vector<ivec3> out;
  for (const std::uint64_t index : about) {
    if (contains(kept, index)) continue;
    int inside = 0;
    for_block(lattice, lattice.voxel(index), [&](const ivec3& v) { inside += volume.at(v) < 0; });
    if (2 * inside <= 27) out.push_back(lattice.voxel(index));
  }
  return out;
}

/// Of the views that a surfel was matched in, the one that looks at it most like `view`.
int nearest_chosen(const ViewChoice& choice, int view, std::span<const projtex::GridCamera> cameras,
                   const glm::dvec3& position) {
  const auto direction = [&](int v) {
    return glm::normalize(cameras[std::size_t(v)].centre - position);
  };
  const glm::dvec3 ray = direction(view);
  int best = choice.reference();
  for (const int other : choice.others())
    if (glm::dot(ray, direction(other)) > glm::dot(ray, direction(best))) best = other;
  return best;
}

}  // namespace

KnownSurface known_surface(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                           std::span<const Peak> peaks, std::span<const ViewChoice> choices,
                           const LookOptions& options) {
  KnownSurface out;
  for (std::size_t i = 0; i < peaks.size(); ++i) {
    if (peaks[i].weight <= 0 || peaks[i].score < options.least_score) continue;
    out.positions.push_back(positions[i] + peaks[i].offset * normals[i]);
    out.normals.push_back(normals[i]);
    out.weights.push_back(peaks[i].weight);
    out.choices.push_back(choices[i]);
  }
  return out;
}

std::vector<Sightline> find_sightlines(gpu::Context& context, const GridSpec& grid,
                                       const KnownSurface& known,
                                       const MatchingPhotographs& photographs,
                                       const MatchOptions& match, const LookOptions& options) {
  const std::vector<projtex::GridCamera> cameras = projtex::to_grid(photographs.cameras(), grid);
  std::vector<PatchSurfel> surfels;
  std::vector<ViewChoice> pairs;  // a witness, and a view that the surfel is hidden from
  for (std::size_t i = 0; i < known.positions.size(); ++i) {
    const ViewChoice& choice = known.choices[i];
    if (choice.views.size() < kLeastViews || known.weights[i] < kLeastWeight) continue;
    for (const int view : choice.hidden) {
      const int witness = nearest_chosen(choice, view, cameras, glm::dvec3(known.positions[i]));
      surfels.push_back({known.positions[i], known.normals[i]});
      pairs.emplace_back().views = ViewList<ViewChoice::kMostViews>(std::array{witness, view});
    }
  }
  std::vector<float> scores(surfels.size(), kNoScore);
  photographs.for_each(
      pairs, [&](const projtex::Photographs& held, std::span<const std::uint32_t> indices,
                 const HeldNumbers& numbers) {
        std::vector<PatchSurfel> some;
        std::vector<ViewChoice> views;
        for (const std::uint32_t i : indices) {
          some.push_back(surfels[i]);
          views.push_back(numbers.of(pairs[i]));
        }
        const PatchMatcher matcher(context, held.images, projtex::to_grid(held.cameras, grid),
                                   patch_rules(match, held.noise_sigma), "refine_match_patches");
        const std::vector<float> found = matcher.match(some, {}, views, {}).scores;
        for (std::size_t k = 0; k < indices.size(); ++k) scores[indices[k]] = found[k];
      });
  std::vector<Sightline> out;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (scores[i] < options.least_score) continue;
    const auto& [at, normal, scale] = surfels[i];
    const int view = pairs[i].others().front();
    const glm::vec3 way = glm::normalize(glm::vec3(cameras[std::size_t(view)].centre) - at);
    out.push_back({at + float(options.margin) / glm::dot(way, normal) * way, view});
  }
  return out;
}

std::size_t free_sightlines(std::span<const Sightline> lines,
                            std::span<const glm::vec3> known_positions,
                            std::span<const Camera> cameras, const LookOptions& options,
                            SparseVolume& volume) {
  if (lines.empty()) return 0;
  const VoxelSet hits = blocked(lines, projtex::to_grid(cameras, volume.grid), volume);
  const VoxelSet kept = around(known_positions, volume.grid);
  const Lattice lattice(volume.grid);
  std::vector<ivec3> fresh;
  for (std::size_t i = 0, end = 0; i < hits.size(); i = end) {
    while (end < hits.size() && hits[end] == hits[i]) ++end;
    if (int(end - i) >= options.least_lines && !contains(kept, hits[i]))
      fresh.push_back(lattice.voxel(hits[i]));
  }
  std::size_t freed = 0;
  for (int pass = 0; !fresh.empty(); ++pass) {
    for (const ivec3& voxel : fresh) stored(voxel, volume) = kFreed;
    freed += fresh.size();
    if (pass == kPasses) break;
    fresh = outnumbered(fresh, kept, volume);
  }
  return freed;
}

}  // namespace photohull::refine
