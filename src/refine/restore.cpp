#include "refine/restore.h"

#include <tbb/parallel_for.h>

#include "refine/coverage.h"
#include "volume/combine.h"
#include "volume/skin.h"

namespace photohull::refine {
namespace {

using glm::ivec3;

class Restorer {
 public:
  Restorer(gpu::Context& context, const SparseVolume& volume, const SparseVolume& hull,
           const SilhouetteCones& cones, const RestoreOptions& options)
      : volume_(volume),
        hull_(hull),
        options_(options),
        coverage_(context, volume.grid, skin(volume), cones),
        lacking_(coverage_.lacking_pixels(options.least_inside)) {}

  /// Voxels that came back, as a volume with the hull's distances at them and their neighbours.
  SparseVolume run(std::size_t& restored) const {
    SparseVolume out;
    out.grid = hull_.grid;
    out.table.assign(hull_.table.size(), SparseVolume::kOutside);
    std::vector<ivec3> bricks;
    const ivec3 n = hull_.grid.bricks;
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x) {
          const std::size_t index = hull_.grid.brick_index({x, y, z});
          if (hull_.table[index] != SparseVolume::kOutside &&
              volume_.table[index] != SparseVolume::kInside)
            bricks.emplace_back(x, y, z);
        }
    std::vector<std::vector<ivec3>> found(bricks.size());
    tbb::parallel_for(std::size_t(0), bricks.size(), [&](std::size_t b) {
      for (int i = 0; i < kBrickVoxels; ++i) {
        const ivec3 voxel = bricks[b] * kBrickEdge + ivec3(i >> 6, (i >> 3) & 7, i & 7);
        if (hull_.at(voxel) < 0 && volume_.at(voxel) > 0 && is_missed(voxel))
          found[b].push_back(voxel);
      }
    });
    for (const std::vector<ivec3>& part : found) {
      restored += part.size();
      for (const ivec3& voxel : part)
        for (int x = -1; x <= 1; ++x)
          for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) store(out, voxel + ivec3(x, y, z));
    }
    return out;
  }

 private:
  bool is_missed(const ivec3& voxel) const {
    if (coverage_.most_lack(glm::dvec3(voxel), lacking_) < options_.least_views) return false;
    const Coverage::Votes votes = coverage_.votes(glm::dvec3(voxel), options_.least_inside);
    return votes.lack >= options_.least_views && votes.before <= options_.most_before * votes.lack;
  }

  void store(SparseVolume& out, const ivec3& voxel) const {
    if (glm::any(glm::lessThan(voxel, ivec3(0))) ||
        glm::any(glm::greaterThanEqual(voxel, out.grid.voxels())))
      return;
    std::uint32_t& entry = out.table[out.grid.brick_index(voxel / kBrickEdge)];
    if (entry == SparseVolume::kOutside) {
      entry = std::uint32_t(out.bricks.size());
      out.bricks.push_back(voxel / kBrickEdge);
      out.distance.resize(out.distance.size() + kBrickVoxels, SparseVolume::kBand);
    }
    out.distance[std::size_t(entry) * kBrickVoxels + std::size_t(voxel_offset(voxel & 7))] =
        hull_.at(voxel);
  }

  const SparseVolume& volume_;
  const SparseVolume& hull_;
  const RestoreOptions& options_;
  Coverage coverage_;
  Coverage::LackingPixels lacking_;
};

}  // namespace

std::size_t restore_silhouettes(gpu::Context& context, SparseVolume& volume,
                                const SparseVolume& hull, const SilhouetteCones& cones,
                                const RestoreOptions& options) {
  std::size_t restored = 0;
  const SparseVolume parts = Restorer(context, volume, hull, cones, options).run(restored);
  if (restored > 0) volume = union_of(volume, parts);
  return restored;
}

}  // namespace photohull::refine
