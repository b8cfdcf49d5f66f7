// Consistency of visibility: a surface that hides another from a view which shows it is not there
// [Merrell07].
#include "refine/look_through.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

#include "projtex/gpu_views.h"

namespace photohull::refine {
namespace {

using glm::ivec3;

constexpr float kFreed = 0.5f;       // distance of a voxel that was freed, voxels
constexpr int kLeastViews = 3;       // that a surfel was matched in
constexpr int kPasses = 3;           // of freeing what freed voxels outnumber
constexpr std::size_t kPart = 1024;  // lines or points that a task takes

/// Voxels by their place in the lattice, x fastest.
class Lattice {
 public:
  explicit Lattice(const GridSpec& grid) : n_(grid.voxels()) {}
  bool contains(const ivec3& v) const {
    return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < n_.x && v.y < n_.y && v.z < n_.z;
  }
  std::uint64_t index(const ivec3& v) const {
    return (std::uint64_t(v.z) * std::uint64_t(n_.y) + std::uint64_t(v.y)) * std::uint64_t(n_.x) +
           std::uint64_t(v.x);
  }
  ivec3 voxel(std::uint64_t i) const {
    const auto x = std::uint64_t(n_.x), y = std::uint64_t(n_.y);
    return {int(i % x), int(i / x % y), int(i / x / y)};
  }

 private:
  ivec3 n_;
};

using Indices = std::vector<std::uint64_t>;

Indices sorted(const std::vector<Indices>& parts) {
  Indices all;
  for (const Indices& part : parts) all.insert(all.end(), part.begin(), part.end());
  tbb::parallel_sort(all.begin(), all.end());
  return all;
}

ivec3 nearest(const glm::dvec3& p) { return ivec3(glm::floor(p + 0.5)); }

std::vector<projtex::GridCamera> on_grid(std::span<const Camera> cameras, const GridSpec& grid) {
  std::vector<projtex::GridCamera> out;
  for (const Camera& camera : cameras) out.push_back(projtex::to_grid(camera, grid));
  return out;
}

/// Calls f(voxel) for a voxel and its 26 neighbours, as far as they lie in the lattice.
template <typename F>
void for_block(const Lattice& lattice, const ivec3& middle, F&& f) {
  for (int i = 0; i < 27; ++i) {
    const ivec3 voxel = middle + ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    if (lattice.contains(voxel)) f(voxel);
  }
}

/// Where lines pass through the volume's inside: a voxel comes as often as lines do.
Indices blocked(std::span<const Sightline> lines, std::span<const projtex::GridCamera> cameras,
                const SparseVolume& volume) {
  const Lattice lattice(volume.grid);
  std::vector<Indices> parts((lines.size() + kPart - 1) / kPart);
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t part) {
    for (std::size_t l = part * kPart; l < std::min(lines.size(), (part + 1) * kPart); ++l) {
      const glm::dvec3 from(lines[l].from);
      const glm::dvec3 way = cameras[std::size_t(lines[l].view)].centre - from;
      // A voxel a step along the longest axis, so that none comes twice.
      const int steps = int(std::max({std::abs(way.x), std::abs(way.y), std::abs(way.z)}));
      for (int i = 0; i < steps; ++i) {
        const ivec3 voxel = nearest(from + double(i) / steps * way);
        if (!lattice.contains(voxel)) break;
        if (volume.at(voxel) < 0) parts[part].push_back(lattice.index(voxel));
      }
    }
  });
  return sorted(parts);
}

Indices around(std::span<const glm::vec3> points, const GridSpec& grid) {
  const Lattice lattice(grid);
  std::vector<Indices> parts((points.size() + kPart - 1) / kPart);
  tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t part) {
    for (std::size_t i = part * kPart; i < std::min(points.size(), (part + 1) * kPart); ++i)
      for_block(lattice, nearest(glm::dvec3(points[i])),
                [&](const ivec3& voxel) { parts[part].push_back(lattice.index(voxel)); });
  });
  Indices out = sorted(parts);
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

bool contains(const Indices& set, std::uint64_t index) {
  return std::binary_search(set.begin(), set.end(), index);
}

/// Voxels beside `fresh` ones that are inside still and have more neighbours outside than inside.
std::vector<ivec3> outnumbered(const std::vector<ivec3>& fresh, const Indices& kept,
                               const SparseVolume& volume) {
  const Lattice lattice(volume.grid);
  Indices about;
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

/// The voxel's place in `volume.distance`; its brick is stored from now on.
float& stored(const ivec3& voxel, SparseVolume& volume) {
  std::uint32_t& entry = volume.table[volume.grid.brick_index(voxel / kBrickEdge)];
  if (entry >= SparseVolume::kInside) {
    const float all = entry == SparseVolume::kInside ? -SparseVolume::kBand : SparseVolume::kBand;
    entry = std::uint32_t(volume.bricks.size());
    volume.bricks.push_back(voxel / kBrickEdge);
    volume.distance.resize(volume.distance.size() + kBrickVoxels, all);
  }
  return volume.distance[std::size_t(entry) * kBrickVoxels + std::size_t(voxel_offset(voxel & 7))];
}

/// Of the views that a surfel was matched in, the one that looks at it most like `view`.
int nearest_chosen(const shaders::MatchChoice& choice, int view,
                   std::span<const projtex::GridCamera> cameras, const glm::dvec3& position) {
  const auto direction = [&](int v) {
    return glm::normalize(cameras[std::size_t(v)].centre - position);
  };
  const int views[shaders::kMatchViews] = {choice.first.x, choice.first.y,  choice.first.z,
                                           choice.first.w, choice.second.x, choice.second.y};
  const glm::dvec3 ray = direction(view);
  int best = views[0];
  for (int k = 1; k < choice.second.w; ++k)
    if (glm::dot(ray, direction(views[k])) > glm::dot(ray, direction(best))) best = views[k];
  return best;
}

}  // namespace

KnownSurface known_surface(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                           std::span<const Peak> peaks,
                           std::span<const shaders::MatchChoice> choices,
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
                                       const KnownSurface& known, const projtex::ImageSet& images,
                                       std::span<const Camera> cameras, double noise_sigma,
                                       const MatchOptions& match, const LookOptions& options) {
  const std::vector<projtex::GridCamera> grid_cameras = on_grid(cameras, grid);
  std::vector<shaders::BakeVertex> surfels;
  std::vector<shaders::MatchChoice> pairs;
  for (std::size_t i = 0; i < known.positions.size(); ++i) {
    const shaders::MatchChoice& choice = known.choices[i];
    if (choice.second.w < kLeastViews || known.weights[i] < options.least_weight) continue;
    for (int k = 0; k < shaders::kHiddenViews && choice.hidden[k] >= 0; ++k) {
      const int view = choice.hidden[k];
      const int witness =
          nearest_chosen(choice, view, grid_cameras, glm::dvec3(known.positions[i]));
      surfels.push_back({glm::vec4(known.positions[i], 1), glm::vec4(known.normals[i], 0)});
      pairs.push_back({{witness, view, -1, -1}, {-1, -1, 0, 2}, glm::ivec4(-1)});
    }
  }
  const std::vector<float> scores =
      match_patches(context, grid, surfels, {}, pairs, images, cameras, noise_sigma, {}, match)
          .scores;
  std::vector<Sightline> out;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (scores[i] < options.least_score) continue;
    const glm::vec3 at(surfels[i].position), normal(surfels[i].normal);
    const int view = pairs[i].first.y;
    const glm::vec3 way = glm::normalize(glm::vec3(grid_cameras[std::size_t(view)].centre) - at);
    out.push_back({at + float(options.margin) / glm::dot(way, normal) * way, view});
  }
  return out;
}

std::size_t free_sightlines(std::span<const Sightline> lines,
                            std::span<const glm::vec3> known_positions,
                            std::span<const Camera> cameras, const LookOptions& options,
                            SparseVolume& volume) {
  if (lines.empty()) return 0;
  const Indices hits = blocked(lines, on_grid(cameras, volume.grid), volume);
  const Indices kept = around(known_positions, volume.grid);
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
