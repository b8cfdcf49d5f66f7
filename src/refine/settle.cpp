#include "refine/settle.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "projtex/photographs.h"

namespace photohull::refine {
namespace {

constexpr std::uint8_t kNone = 255;  // no surface in the brick

/// Of the distance, outward.
glm::dvec3 slope_at(const SparseVolume& volume, const glm::ivec3& voxel) {
  glm::dvec3 slope;
  for (int a = 0; a < 3; ++a) {
    glm::ivec3 step(0);
    step[a] = 1;
    slope[a] = double(volume.at(voxel + step)) - double(volume.at(voxel - step));
  }
  return slope;
}

/// Pixels of half a voxel in the view that a place on the surface looks at most straight, which
/// surfels are matched with as a rule; 0: no view shows its outer side.
double half_voxel(const glm::dvec3& place, const glm::dvec3& outward,
                  std::span<const projtex::GridCamera> cameras) {
  double straightest = 0, pixels = 0;
  for (const projtex::GridCamera& camera : cameras) {
    const glm::dvec3 ray = camera.centre - place;
    const double distance = glm::length(ray), facing = glm::dot(outward, ray) / distance;
    const glm::dvec3 p = camera.projection * glm::dvec4(place, 1);
    const bool on_image =
        p.z > 1 && p.x > 0 && p.y > 0 && p.x < camera.width * p.z && p.y < camera.height * p.z;
    if (!on_image || facing <= straightest) continue;
    straightest = facing;
    pixels = 0.5 * camera.focal / distance;
  }
  return pixels;
}

double size_of(const glm::vec3& bend) {
  return std::sqrt(bend.x * bend.x + 2 * bend.y * bend.y + bend.z * bend.z);
}

}  // namespace

SettledBricks::SettledBricks(const GridSpec& grid, const MatchedSurfels& surfels,
                             std::span<const Camera> cameras, const SettleOptions& options)
    : grid_(grid), kinds_(grid.brick_count(), kNone) {
  const std::vector<projtex::GridCamera> on_grid = projtex::to_grid(cameras, grid);
  const auto kind_of = [&](std::size_t i) {
    if (is_settled(surfels.before[i])) return surfels.before[i];
    if (!surfels.choices[i].comparable()) return Settled::kUnseen;
    const projtex::GridCamera& camera = on_grid[std::size_t(surfels.choices[i].reference())];
    const double distance = glm::distance(camera.centre, glm::dvec3(surfels.positions[i]));
    if (0.5 * camera.focal / distance < options.least_pixels) return Settled::kPixels;
    if (surfels.texture[i] < options.least_texture) return Settled::kPlain;
    const bool flat = !surfels.bends.empty() && size_of(surfels.bends[i]) < options.flat;
    return flat && surfels.peaks[i].weight > 0.5f ? Settled::kFlat : Settled::kSplit;
  };
  const glm::ivec3 last = grid.voxels() - 1;
  for (std::size_t i = 0; i < surfels.positions.size(); ++i) {
    const glm::ivec3 voxel =
        glm::clamp(glm::ivec3(glm::floor(surfels.positions[i] + 0.5f)), glm::ivec3(0), last);
    std::uint8_t& brick = kinds_[grid.brick_index(voxel / kBrickEdge)];
    brick = std::min(brick, std::uint8_t(kind_of(i)));
  }
}

SettledBricks settled_below_pixels(const SparseVolume& surface, std::span<const Camera> cameras,
                                   const SettleOptions& options) {
  const GridSpec& grid = surface.grid;
  const std::vector<projtex::GridCamera> on_grid = projtex::to_grid(cameras, grid);
  std::vector<std::uint8_t> kinds(grid.brick_count(), kNone);
  tbb::parallel_for(std::size_t(0), surface.bricks.size(), [&](std::size_t slot) {
    const glm::ivec3 corner = surface.bricks[slot] * kBrickEdge;
    double pixels = 0;  // of half a voxel, the most of all places
    for (int i = 0; i < kBrickVoxels; ++i) {
      const float d = surface.distance[slot * kBrickVoxels + std::size_t(i)];
      if (d > 0 || d <= -1) continue;
      const glm::ivec3 voxel = corner + glm::ivec3(i >> 6, (i >> 3) & 7, i & 7);
      pixels = std::max(pixels, half_voxel(voxel, slope_at(surface, voxel), on_grid));
    }
    const bool settled = pixels > 0 && pixels < options.least_pixels;
    kinds[grid.brick_index(surface.bricks[slot])] =
        std::uint8_t(settled ? Settled::kPixels : Settled::kSplit);
  });
  return {grid, std::move(kinds)};
}

std::vector<Settled> SettledBricks::at(const GridSpec& grid,
                                       std::span<const glm::vec3> positions) const {
  std::vector<Settled> out(positions.size(), Settled::kSplit);
  if (kinds_.empty()) return out;
  const glm::dvec3 offset = (grid.origin - grid_.origin) / grid_.voxel_size;
  const double scale = grid.voxel_size / grid_.voxel_size;
  const glm::ivec3 last = grid_.voxels() - 1;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const glm::dvec3 at = scale * glm::dvec3(positions[i]) + offset;
    const glm::ivec3 voxel = glm::clamp(glm::ivec3(glm::floor(at + 0.5)), glm::ivec3(0), last);
    const std::uint8_t kind = kinds_[grid_.brick_index(voxel / kBrickEdge)];
    if (kind != kNone) out[i] = Settled(kind);
  }
  return out;
}

std::vector<std::uint8_t> SettledBricks::coarse(const GridSpec& grid) const {
  std::vector<std::uint8_t> out(kinds_.empty() ? 0 : grid.brick_count(), 0);
  const double half = 0.5 * (kBrickEdge - 1);
  std::size_t index = 0;
  for (int z = 0; z < grid.bricks.z && !out.empty(); ++z)
    for (int y = 0; y < grid.bricks.y; ++y)
      for (int x = 0; x < grid.bricks.x; ++x, ++index) {
        const glm::dvec3 middle = grid.world(glm::dvec3(glm::ivec3(x, y, z) * kBrickEdge) + half);
        const glm::dvec3 at = (middle - grid_.origin) / grid_.voxel_size + 0.5;
        const glm::ivec3 voxel =
            glm::clamp(glm::ivec3(glm::floor(at)), glm::ivec3(0), grid_.voxels() - 1);
        const std::uint8_t kind = kinds_[grid_.brick_index(voxel / kBrickEdge)];
        out[index] = kind != kNone && is_settled(Settled(kind));
      }
  return out;
}

std::int64_t SettledBricks::count(Settled kind) const {
  return std::count(kinds_.begin(), kinds_.end(), std::uint8_t(kind));
}

}  // namespace photohull::refine
