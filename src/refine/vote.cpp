// Depth maps vote on free space [Merrell07] by signed distances along lines of sight
// [CurlessLevoy96].
#include "refine/vote.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "refine/ray_maps.h"
#include "refine/voxel_set.h"

namespace photohull::refine {
namespace {

constexpr float kLeastChange =
    1;  // voxels: a voxel's distance that votes change by less stays as it is

constexpr float kCertain = 1000;  // evidence where the hull is not
constexpr float kBesides = 0.3f;  // voxels: distance where the rays say the opposite of the label

class Voter {
 public:
  Voter(const SparseVolume& hull, std::span<const Camera> cameras, std::vector<RayMap> maps,
        const VoteOptions& options)
      : hull_(hull),
        options_(options),
        maps_(std::move(maps)),
        cameras_(projtex::to_grid(cameras, hull.grid)) {}

  /// Asks again about voxels beside what rays found before the volume's surface, and beside where
  /// they passed through it.
  Revision revise(SparseVolume& volume) const {
    Revision out;
    for_votes(&RayMap::before, volume.grid, options_.least_weight, SparseVolume::kBand,
              [&](const glm::ivec3& voxel, float value) {
                const float old = volume.at(voxel);
                if (value > old - kLeastChange) return;
                out.added += value < 0 && old >= 0;
                stored(voxel, volume) = value;
              });
    for_votes(&RayMap::through, volume.grid, options_.freeing_weight, -SparseVolume::kBand,
              [&](const glm::ivec3& voxel, float value) {
                const float old = volume.at(voxel);
                if (value < old + kLeastChange || value < 0) return;
                out.freed += old < 0;
                stored(voxel, volume) = value;
              });
    return out;
  }

  SparseVolume fuse() {
    std::vector<glm::ivec3> bricks = bricks_of_hull();
    std::vector<float> values(bricks.size() * kBrickVoxels);
    for_each_voxel(bricks,
                   [&](std::size_t i, const glm::ivec3& voxel) { values[i] = hull_.at(voxel); });
    for_some(values.size(), [&](std::size_t first, std::size_t end) {
      Asked asked;
      for (std::size_t i = first; i < end; ++i)
        if (!(values[i] > 1)) asked.add(i, voxel_of(bricks, i));
      for (std::size_t k = 0; const Say& say : ask(asked)) {
        float& value = values[asked.index[k++]];
        value = std::max(value, vote(say, options_.least_weight, -SparseVolume::kBand));
      }
    });
    return volume_of(std::move(bricks), std::move(values));
  }

  SparseVolume label(gpu::Context& context, const LabelOptions& options) {
    std::vector<glm::ivec3> bricks = bricks_of_hull();
    std::vector<float> told(bricks.size() * kBrickVoxels), evidence(told.size());
    for_some(told.size(), [&](std::size_t first, std::size_t end) {
      Asked asked;
      for (std::size_t i = first; i < end; ++i) asked.add(i, voxel_of(bricks, i));
      for (std::size_t i = first; const Say& say : ask(asked)) {
        told[i] = say.total > 0 ? float(say.sum / say.total * options_.band) : 0;
        evidence[i++] = float(say.sum);
      }
    });
    const double usual = usual_claim(evidence);
    for_each_voxel(bricks, [&](std::size_t i, const glm::ivec3& voxel) {
      evidence[i] = hull_.at(voxel) > 0
                        ? kCertain
                        : float(options.evidence / usual * double(evidence[i]) + options.unknown);
    });
    std::vector<float> labels = label_space(context, bricks, evidence, options.iterations);
    for_each_voxel(bricks, [&](std::size_t i, const glm::ivec3& voxel) {
      labels[i] = std::max(hull_.at(voxel), distance_of(labels[i] > 0.5f, told[i]));
    });
    return volume_of(std::move(bricks), std::move(labels));
  }

 private:
  /// The sum of the rays' weighted says about a point, and of their weights.
  struct Say {
    double sum = 0, total = 0;
  };

  /// Signed distance of a labelled voxel: what the rays say, where they say the same.
  static float distance_of(bool solid, float told) {
    if (told == 0) return solid ? -1 : 1;
    if (solid == (told < 0)) return told;
    return solid ? -kBesides : kBesides;
  }

  /// The upper quartile of what claims voxels: the more views there are and the surer they are, the
  /// more say each voxel has. 1 where nothing is claimed.
  static double usual_claim(std::vector<float> sums) {
    std::erase_if(sums, [](float sum) { return sum >= 0; });
    if (sums.empty()) return 1;
    const auto at = sums.begin() + long(sums.size() / 4);
    std::nth_element(sums.begin(), at, sums.end());
    return -double(*at);
  }

  /// Those that are not outside.
  std::vector<glm::ivec3> bricks_of_hull() const {
    const glm::ivec3 n = hull_.grid.bricks;
    std::vector<glm::ivec3> bricks;
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x)
          if (hull_.table[hull_.grid.brick_index({x, y, z})] != SparseVolume::kOutside)
            bricks.emplace_back(x, y, z);
    return bricks;
  }

  /// Calls visit(first, end) for parts of `count` things that can be asked about at once, in
  /// parallel.
  template <typename Visit>
  static void for_some(std::size_t count, const Visit& visit) {
    tbb::parallel_for(std::size_t(0), (count + kAtOnce - 1) / kAtOnce, [&](std::size_t part) {
      visit(part * kAtOnce, std::min(count, (part + 1) * kAtOnce));
    });
  }

  /// The i-th voxel of the bricks.
  static glm::ivec3 voxel_of(const std::vector<glm::ivec3>& bricks, std::size_t i) {
    const int v = int(i % kBrickVoxels);
    return bricks[i / kBrickVoxels] * kBrickEdge + glm::ivec3(v >> 6, (v >> 3) & 7, v & 7);
  }

  /// Calls visit(index, voxel) for all voxels of the bricks, in parallel.
  template <typename Visit>
  static void for_each_voxel(const std::vector<glm::ivec3>& bricks, const Visit& visit) {
    tbb::parallel_for(std::size_t(0), bricks.size(), [&](std::size_t b) {
      for (int x = 0; x < kBrickEdge; ++x)
        for (int y = 0; y < kBrickEdge; ++y)
          for (int z = 0; z < kBrickEdge; ++z)
            visit(b * kBrickVoxels + std::size_t(voxel_offset({x, y, z})),
                  bricks[b] * kBrickEdge + glm::ivec3(x, y, z));
    });
  }

  SparseVolume volume_of(std::vector<glm::ivec3> bricks, std::vector<float> distance) const {
    SparseVolume out;
    out.grid = hull_.grid;
    out.table.assign(hull_.table.size(), SparseVolume::kOutside);
    for (std::size_t b = 0; b < bricks.size(); ++b)
      out.table[out.grid.brick_index(bricks[b])] = std::uint32_t(b);
    out.bricks = std::move(bricks);
    out.distance = std::move(distance);
    return out;
  }

  /// Calls use(voxel, vote) for the voxels beside points of the maps, in the lattice's order.
  template <typename Use>
  void for_votes(std::vector<glm::vec3> RayMap::*points, const GridSpec& grid, double least,
                 double silent, const Use& use) const {
    std::vector<std::span<const glm::vec3>> lists;
    for (const RayMap& map : maps_) lists.emplace_back(map.*points);
    const Lattice lattice(grid);
    std::vector<float> votes;
    for_around(lists, grid, [&](const VoxelSet& voxels) {
      votes.resize(voxels.size());
      for_some(voxels.size(), [&](std::size_t first, std::size_t end) {
        Asked asked;
        for (std::size_t i = first; i < end; ++i) asked.add(i, lattice.voxel(voxels[i]));
        for (std::size_t i = first; const Say& say : ask(asked)) {
          votes[i] = std::max(hull_.at(lattice.voxel(voxels[i])), vote(say, least, silent));
          ++i;
        }
      });
      for (std::size_t i = 0; i < voxels.size(); ++i) use(lattice.voxel(voxels[i]), votes[i]);
    });
  }

  /// `silent`: where the rays say too little, their weights' sum being below `least`.
  float vote(const Say& say, double least, double silent) const {
    return float(say.total < least ? silent : say.sum / say.total * options_.band);
  }

  /// Voxels that are asked about at once: view by view for all of them, for vectors of them are
  /// projected faster than one.
  static constexpr std::size_t kAtOnce = 64;
  struct Asked {
    std::size_t count = 0;
    std::array<std::size_t, kAtOnce> index;  // of the caller's
    std::array<double, kAtOnce> x, y, z;
    std::array<Say, kAtOnce> says;

    void add(std::size_t i, const glm::ivec3& voxel) {
      index[count] = i;
      x[count] = voxel.x, y[count] = voxel.y, z[count] = voxel.z;
      ++count;
    }
  };

  /// Each ray's say is 1 from `band` before its depth on, -1 at `band` behind it, and nothing
  /// beyond.
  std::span<const Say> ask(Asked& asked) const {
    std::array<double, kAtOnce> depth, column, row;
    for (std::size_t v = 0; v < cameras_.size(); ++v) {
      const RayMap& map = maps_[v];
      const auto& m = cameras_[v].projection;
      for (std::size_t i = 0; i < asked.count; ++i) {
        const double x = asked.x[i], y = asked.y[i], z = asked.z[i];
        const double q = m[0].z * x + m[1].z * y + m[2].z * z + m[3].z;
        depth[i] = q;
        column[i] =
            ((m[0].x * x + m[1].x * y + m[2].x * z + m[3].x) / q + 0.5) / map.stride + map.shift.x;
        row[i] =
            ((m[0].y * x + m[1].y * y + m[2].y * z + m[3].y) / q + 0.5) / map.stride + map.shift.y;
      }
      for (std::size_t i = 0; i < asked.count; ++i) {
        if (!(depth[i] > 1 && column[i] >= 0 && row[i] >= 0 && column[i] < map.width &&
              row[i] < map.height))
          continue;
        const std::size_t at =
            std::size_t(int(row[i])) * std::size_t(map.width) + std::size_t(int(column[i]));
        if (!(map.weight[at] > 0)) continue;
        const double ahead = (map.depth[at] - depth[i]) / options_.band;
        if (ahead < -1) continue;
        asked.says[i].sum += map.weight[at] * std::min(ahead, 1.0);
        asked.says[i].total += map.weight[at];
      }
    }
    return std::span(asked.says).first(asked.count);
  }

  const SparseVolume& hull_;
  const VoteOptions& options_;
  std::vector<RayMap> maps_;
  std::vector<projtex::GridCamera> cameras_;
};

}  // namespace

SparseVolume vote_free_space(gpu::Context& context, const SparseVolume& hull,
                             const projtex::Photographs& photographs, const VoteOptions& options,
                             SharedWork* shared) {
  return Voter(hull, photographs.cameras, match_rays(context, hull, photographs, options, shared),
               options)
      .fuse();
}

SparseVolume label_by_votes(gpu::Context& context, const SparseVolume& hull,
                            const projtex::Photographs& photographs, const VoteOptions& options,
                            const LabelOptions& label, SharedWork* shared) {
  return Voter(hull, photographs.cameras, match_rays(context, hull, photographs, options, shared),
               options)
      .label(context, label);
}

Revision vote_again(gpu::Context& context, SparseVolume& volume, const SparseVolume& hull,
                    const projtex::Photographs& photographs, VoteOptions options,
                    SharedWork* shared) {
  options.ray_spacing = options.again_spacing;
  options.least_score = options.again_score;
  options.least_weight = options.again_weight;
  return Voter(hull, photographs.cameras,
               match_rays_again(context, hull, volume, photographs, options, shared), options)
      .revise(volume);
}

}  // namespace photohull::refine
