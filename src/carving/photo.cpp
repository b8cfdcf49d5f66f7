// Based on: S. Seitz, C. Dyer, "Photorealistic scene reconstruction by voxel coloring", CVPR 1997;
// K. Kutulakos, S. Seitz, "A theory of shape by space carving", IJCV 2000; and, for the evaluation
// on reference planes by projective texture mapping, A. Montenegro's thesis, chapter 3.
#include "carving/photo.h"

#include <algorithm>
#include <list>
#include <utility>
#include <variant>

#include "carving/bit_volume.h"
#include "carving/decisions.h"
#include "carving/kernels/layer_sampling.h"
#include "carving/kernels/read_decisions.h"
#include "carving/kernels/sweep_bands.h"
#include "carving/kernels/sweep_device.h"
#include "carving/layer_item.h"
#include "core/error.h"
#include "projtex/photographs.h"

namespace photohull::carving {
namespace {

using glm::ivec3;

// Voxels carved in a round per voxel judged below which another round changes nothing measurable.
constexpr double kNegligible = 0.03;

using Direction = SweepDirection;

class Sweeper {
 public:
  Sweeper(gpu::Context& context, const SparseVolume& hull, LayerSampling sampling,
          std::span<const Camera> cameras, const PhotoOptions& options)
      : bits_(to_bits(hull)),
        cameras_(projtex::to_grid(cameras, hull.grid)),
        device_(context, bits_, cameras_, std::move(sampling), options) {
    std::vector<std::uint32_t> active(hull.table.size());
    for (std::size_t i = 0; i < active.size(); ++i)
      active[i] = hull.table[i] < SparseVolume::kInside;
    device_.set_active(active);
  }

  /// Cameras that look along the direction from outside the grid's far half.
  int cameras_along(const Direction& d) const {
    const glm::dvec3 centre = 0.5 * glm::dvec3(bits_.grid.voxels());
    int count = 0;
    for (const auto& camera : cameras_)
      count += sweep_cosine(camera, centre, d) > kLeastSweepCosine;
    return count;
  }

  /// One sweep; returns the number of voxels carved.
  std::int64_t sweep(const Direction& direction, Progress& progress) {
    direction_ = direction;
    const ivec3 grid = bits_.grid.bricks;
    const std::vector<Band> bands =
        make_bands(grid[(direction.axis + 1) % 3], grid[(direction.axis + 2) % 3]);
    device_.begin(direction);
    std::vector<Decision> decisions;
    for (int slab = 0; slab < grid[direction.axis]; ++slab) {
      progress.check_cancelled();
      std::list<BandWork> work = work_of(slab, bands);
      for (int layer = slab * kBrickEdge; layer < (slab + 1) * kBrickEdge; ++layer) {
        // All of a layer is judged before any of it hides what comes behind.
        for (BandWork& part : work) counts_.samples += device_.judge_layer(layer, part);
        for (BandWork& part : work) device_.hide_behind(layer, part);
      }
      for (const BandWork& part : work)
        counts_.judged += read_decisions(part.decided.buffer, decisions);
    }
    return apply(decisions);
  }

  const PhotoReport& counts() const { return counts_; }
  BitVolume result() { return std::move(bits_); }

 private:
  std::int64_t apply(const std::vector<Decision>& decisions) {
    const std::vector<ivec3> carved =
        apply_decisions(bits_, direction_.axis, direction_.sign, decisions);
    for (const Decision& d : decisions) {
      counts_.undecided += d.outcome == Outcome::kUnseen;
      counts_.reverted += d.outcome == Outcome::kUndecided;
    }
    counts_.carved += std::int64_t(carved.size());
    device_.set_standing(bits_);
    std::vector<std::uint32_t> active = device_.active();
    for (const ivec3& voxel : carved)
      for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
          ivec3 neighbour = voxel;
          neighbour[axis] = std::clamp(voxel[axis] + side, 0, bits_.grid.voxels()[axis] - 1);
          active[bits_.grid.brick_index(neighbour / kBrickEdge)] = 1;
        }
    device_.set_active(active);
    return std::int64_t(carved.size());
  }

  /// The active bricks of a slab, by bands that have any.
  std::list<BandWork> work_of(int slab, const std::vector<Band>& bands) const {
    const ivec3 grid = bits_.grid.bricks;
    const int along = direction_.sign > 0 ? slab : grid[direction_.axis] - 1 - slab;
    const std::vector<std::uint32_t> active = device_.active();
    std::list<BandWork> work;
    const int u = (direction_.axis + 1) % 3, v = (direction_.axis + 2) % 3;
    ivec3 brick;
    brick[direction_.axis] = along;
    for (const Band& band : bands) {
      std::vector<LayerItem> items;
      for (brick[v] = band.first_row; band.has(brick[v]); ++brick[v])
        for (brick[u] = 0; brick[u] < grid[u]; ++brick[u]) {
          const std::size_t index = bits_.grid.brick_index(brick);
          // An open path may lead through empty bricks.
          if (active[index]) items.push_back(layer_item(brick, direction_, cameras_));
        }
      if (!items.empty()) work.emplace_back(band, items);
    }
    return work;
  }

  BitVolume bits_;
  std::vector<projtex::GridCamera> cameras_;
  SweepDevice device_;
  Direction direction_{};
  PhotoReport counts_;
};

/// The sweeps of a round. Those that most cameras look along come first: they see the surface best,
/// and what they settle the others find settled.
std::vector<Direction> directions_of(const PhotoOptions& options, const Sweeper& sweeper) {
  std::vector<Direction> all;
  for (int axis = 0; axis < 3; ++axis)
    for (const int sign : {1, -1}) all.push_back({axis, sign});
  std::stable_sort(all.begin(), all.end(), [&](const Direction& a, const Direction& b) {
    return sweeper.cameras_along(a) > sweeper.cameras_along(b);
  });
  if (options.method == PhotoMethod::kVoxelColoring) all.resize(1);
  return all;
}

}  // namespace

SparseVolume carve_photo(gpu::Context& context, const SparseVolume& hull,
                         const SweptPhotographs& photographs, const PhotoOptions& options,
                         Progress& progress, PhotoReport* report) {
  options.validate();
  LayerSampling sampling = std::visit(
      [&](const auto& images) {
        PHOTOHULL_CHECK_OP(int(photographs.cameras.size()), ==, images.get().layers());
        return layer_sampling(context, images.get(), options);
      },
      photographs.images);
  const char* launch = sampling.launch;
  const double sampled_before = context.statistics()[launch].seconds;
  Sweeper sweeper(context, hull, std::move(sampling), photographs.cameras, options);
  const std::vector<Direction> directions = directions_of(options, sweeper);
  const int rounds = options.method == PhotoMethod::kSpaceCarving ? options.max_rounds : 1;
  int round = 0, sweeps = 0;
  for (std::int64_t judged = 0; round < rounds;) {
    std::int64_t carved = 0;
    for (const Direction& direction : directions) {
      carved += sweeper.sweep(direction, progress);
      progress.update(double(++sweeps) / double(rounds * int(directions.size())));
    }
    ++round;
    const std::int64_t judged_now = sweeper.counts().judged - judged;
    judged += judged_now;
    if (double(carved) <= kNegligible * double(judged_now)) break;
  }
  if (report) {
    *report = sweeper.counts();
    report->rounds = round;
    report->sweeps = sweeps;
    report->sampling_seconds = context.statistics()[launch].seconds - sampled_before;
  }
  return carved_distance(hull, sweeper.result());
}

}  // namespace photohull::carving
