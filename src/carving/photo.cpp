// Based on: S. Seitz, C. Dyer, "Photorealistic scene reconstruction by voxel coloring", CVPR 1997;
// K. Kutulakos, S. Seitz, "A theory of shape by space carving", IJCV 2000; and, for the evaluation
// on reference planes by projective texture mapping, A. Montenegro's thesis, chapter 3.
#include "carving/photo.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <list>
#include <utility>

#include "carving/bit_volume.h"
#include "carving/decisions.h"
#include "carving/kernels/read_decisions.h"
#include "carving/layer_item.h"
#include "carving/search_disc.h"
#include "carving/sweep_bands.h"
#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "shared/sweep.h"
#include "visibility/depth_maps.h"

namespace photohull::carving {
namespace {

using glm::ivec3;
using gpu::Buffer;
using gpu::Program;

// Of the samples of a brick's part of a layer, at a search offset.
constexpr std::size_t kSampleBytes = shaders::kMaxLayerViews * shaders::kApronArea * 16;
constexpr std::size_t kChunk = 1024;  // bricks, at a search offset each, whose samples are held
// Voxels carved in a round per voxel judged below which another round changes nothing measurable.
constexpr double kNegligible = 0.03;
// Of statistics whose confidence is 0 where there is too little evidence.
constexpr float kLeastConfidence = 1e-6f;

/// How photographs come onto the layers.
struct Resampling {
  const char* name;  ///< of the launches
  std::shared_ptr<const Program> program;
  std::function<void(const Program&)> bind;
  glm::ivec2 size;  ///< pixels of the array texture
  bool coverage;    ///< alpha tells how much of a sample is the object's
};

using Direction = SweepDirection;

class Sweeper {
 public:
  Sweeper(gpu::Context& context, const SparseVolume& hull, Resampling resampling,
          std::span<const Camera> cameras, const PhotoOptions& options)
      : context_(context),
        resampling_(std::move(resampling)),
        options_(options),
        search_(search_disc(options.search_radius)),
        chunk_(gpu::batch_size(search_.size() * kSampleBytes,
                               std::max<std::size_t>(kChunk / search_.size(), 1))),
        bits_(to_bits(hull)),
        cameras_(to_grid(cameras, hull.grid)),
        maps_(cameras_, hull.grid),
        select_(Program::compute(context, "carving_select_columns.comp.glsl")),
        score_(Program::compute(context, "carving_score_columns.comp.glsl",
                                statistic_defines(options.statistic, resampling_.coverage) +
                                    search_defines(search_) + maps_.defines() +
                                    visibility::sweep_test_defines(options.visibility))),
        update_(Program::compute(context, "carving_update_columns.comp.glsl")),
        mark_(Program::compute(context, "carving_mark_passed.comp.glsl")) {
    std::vector<shaders::GpuView> views;
    for (const auto& camera : cameras_)
      views.push_back(projtex::to_gpu_view(camera, resampling_.size));
    views_ = Buffer::of(views);
    table_ = Buffer::of(bits_.table);
    occupancy_ = Buffer::of(bits_.words);
    passed_ = Buffer(std::max<std::size_t>(bits_.words.size(), 4) * 4);
    std::vector<std::uint32_t> active(hull.table.size());
    for (std::size_t i = 0; i < active.size(); ++i)
      active[i] = hull.table[i] < SparseVolume::kInside;
    active_ = Buffer::of(active);
    samples_ = Buffer(chunk_ * search_.size() * kSampleBytes);
    const float least_texture = float(std::pow(options.min_texture * options.noise_sigma, 2));
    // The confidence of a correlation is the texture.
    const bool correlation = options.statistic == Statistic::kZncc;
    parameters_.noise = {float(options.noise_sigma * options.noise_sigma),
                         correlation ? least_texture : kLeastConfidence, least_texture, 0};
    parameters_.thresholds = {float(options.keep_score), float(options.better_by),
                              float(options.min_views), float(options.depth_bias)};
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
    const int u = (direction.axis + 1) % 3, v = (direction.axis + 2) % 3;
    parameters_.axes = {u, v, direction.axis, direction.sign};
    parameters_.layer = {0, 0, 0, options_.front_face};
    const std::vector<Band> bands = make_bands(grid[u], grid[v]);
    maps_.clear();
    passed_.fill(0);
    std::vector<Decision> decisions;
    for (int slab = 0; slab < grid[direction.axis]; ++slab) {
      progress.check_cancelled();
      parameters_.bricks = glm::ivec4(grid, 0);
      std::list<BandWork> work = work_of(slab, bands);
      for (int layer = slab * kBrickEdge; layer < (slab + 1) * kBrickEdge; ++layer) {
        // All of a layer is judged before any of it hides what comes behind.
        for (BandWork& part : work) judge_layer(layer, part);
        for (BandWork& part : work) hide_behind(part);
      }
      for (const BandWork& part : work)
        counts_.judged += read_decisions(part.decided.buffer, decisions);
    }
    return apply(decisions);
  }

  const PhotoReport& counts() const { return counts_; }
  BitVolume result() { return std::move(bits_); }

 private:
  static std::vector<projtex::GridCamera> to_grid(std::span<const Camera> cameras,
                                                  const GridSpec& grid) {
    std::vector<projtex::GridCamera> out;
    for (const Camera& camera : cameras) out.push_back(projtex::to_grid(camera, grid));
    return out;
  }

  std::int64_t apply(const std::vector<Decision>& decisions) {
    const std::vector<ivec3> carved =
        apply_decisions(bits_, direction_.axis, direction_.sign, decisions);
    for (const Decision& d : decisions) {
      counts_.undecided += d.outcome == Outcome::kUnseen;
      counts_.reverted += d.outcome == Outcome::kUndecided;
    }
    counts_.carved += std::int64_t(carved.size());
    occupancy_ = Buffer::of(bits_.words);
    auto active = active_.download<std::uint32_t>(bits_.table.size());
    for (const ivec3& voxel : carved)
      for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
          ivec3 neighbour = voxel;
          neighbour[axis] = std::clamp(voxel[axis] + side, 0, bits_.grid.voxels()[axis] - 1);
          active[bits_.grid.brick_index(neighbour / kBrickEdge)] = 1;
        }
    active_ = Buffer::of(active);
    return std::int64_t(carved.size());
  }

  /// The active bricks of a slab, by bands that have any.
  std::list<BandWork> work_of(int slab, const std::vector<Band>& bands) const {
    const ivec3 grid = bits_.grid.bricks;
    const int along = direction_.sign > 0 ? slab : grid[direction_.axis] - 1 - slab;
    const auto active = active_.download<std::uint32_t>(bits_.table.size());
    std::list<BandWork> work;
    const int u = (direction_.axis + 1) % 3, v = (direction_.axis + 2) % 3;
    ivec3 brick;
    brick[direction_.axis] = along;
    for (const Band& band : bands) {
      std::vector<shaders::LayerItem> items;
      for (brick[v] = band.first_row; band.has(brick[v]); ++brick[v])
        for (brick[u] = 0; brick[u] < grid[u]; ++brick[u]) {
          const std::size_t index = bits_.grid.brick_index(brick);
          // An open path may lead through empty bricks.
          if (active[index]) items.push_back(layer_item(brick, direction_, cameras_));
        }
      if (!items.empty()) work.emplace_back(band, std::move(items));
    }
    return work;
  }

  /// All but what a step reads or writes at kOccludersBinding or kSweepSamplesBinding.
  void bind(std::size_t first_entry, std::size_t first_column, const BandWork& work,
            std::size_t columns = 0) {
    parameters_.bricks.w = int(work.items.size());
    parameters_.layer.y = work.band.first_row * kBrickEdge;
    parameters_.chunk = {int(first_entry), options_.max_path, int(first_column), int(columns)};
    uniforms_.write(0, sizeof parameters_, &parameters_);
    uniforms_.bind_uniform(shaders::kSweepParametersBinding);
    views_.bind_storage(shaders::kViewsBinding);
    work.item_buffer.bind_storage(shaders::kSweepItemsBinding);
    table_.bind_storage(shaders::kSweepTableBinding);
    occupancy_.bind_storage(shaders::kSweepOccupancyBinding);
    work.band.columns.bind_storage(shaders::kSweepColumnsBinding);
    work.selected.buffer.bind_storage(shaders::kSweepSelectedBinding);
    work.scores.bind_storage(shaders::kSweepScoresBinding);
    maps_.bind();
    active_.bind_storage(shaders::kSweepActiveBinding);
    work.decided.buffer.bind_storage(shaders::kSweepDecisionsBinding);
    packed_.bind_storage(shaders::kSweepSelectedColumnsBinding);
    passed_.bind_storage(shaders::kSweepPassedBinding);
  }

  void judge_layer(int layer, BandWork& work) {
    parameters_.layer.x = layer;
    work.selected.clear();
    work.occluders.clear();
    columns_of_layer_.clear();
    bind(0, 0, work);
    work.occluders.buffer.bind_storage(shaders::kOccludersBinding);
    select_->dispatch(context_, "carving_select_columns", work.items.size());
    const std::size_t count = pack_columns(work.selected);
    std::size_t column = 0;
    for (std::size_t first = 0; first < count; first += chunk_) {
      const std::size_t end = std::min(first + chunk_, count), first_column = column;
      while (column < columns_of_layer_.size() && columns_of_layer_[column] >> 6 < end) ++column;
      bind(first, first_column, work, column - first_column);
      samples_.bind_storage(shaders::kSweepSamplesBinding);
      resampling_.bind(*resampling_.program);
      resampling_.program->dispatch(context_, resampling_.name, end - first, search_.size());
      score_->dispatch(context_, "carving_score_columns",
                       gpu::group_count(column - first_column, 64));
      counts_.samples += std::int64_t(end - first) * shaders::kMaxLayerViews * shaders::kApronArea *
                         options_.supersample * options_.supersample * std::int64_t(search_.size());
    }
    bind(0, 0, work, columns_of_layer_.size());
    work.occluders.buffer.bind_storage(shaders::kOccludersBinding);
    update_->dispatch(context_, "carving_update_columns",
                      gpu::group_count(columns_of_layer_.size(), 64));
  }

  /// What stands on the layer hides what the sweep comes to.
  void hide_behind(const BandWork& work) {
    bind(0, 0, work);
    work.occluders.buffer.bind_storage(shaders::kOccludersBinding);
    const std::size_t count = work.occluders.count();
    if (options_.visibility == visibility::SweepTest::kRays)
      mark_->dispatch(context_, "carving_mark_passed", gpu::group_count(count, 64));
    else
      maps_.splat(context_, work.occluders.buffer, count);
  }

  /// Puts the selected bricks in the order of their items, so that a run never depends on the
  /// device's scheduling, and lists their columns. Returns the number of bricks.
  std::size_t pack_columns(DeviceList& selected) {
    const std::size_t count = selected.count();
    auto entries = std::vector<glm::uvec4>(count);
    selected.buffer.read(16, count * 16, entries.data());
    std::sort(entries.begin(), entries.end(),
              [](const glm::uvec4& a, const glm::uvec4& b) { return a.x < b.x; });
    selected.buffer.write(16, count * 16, entries.data());
    for (std::size_t entry = 0; entry < count; ++entry)
      for (std::uint32_t column = 0; column < 64; ++column)
        if (entries[entry][1 + int(column / 32)] >> (column % 32) & 1)
          columns_of_layer_.push_back(std::uint32_t(entry * 64) + column);
    packed_ = Buffer::of(columns_of_layer_);
    return count;
  }

  gpu::Context& context_;
  Resampling resampling_;
  PhotoOptions options_;
  std::vector<glm::dvec2> search_;  ///< offsets at which views look for a voxel
  std::size_t chunk_;               ///< bricks whose samples are held at once
  BitVolume bits_;
  std::vector<projtex::GridCamera> cameras_;
  visibility::DepthMaps maps_;
  std::shared_ptr<const Program> select_, score_, update_, mark_;
  Buffer views_, table_, occupancy_, active_, samples_, packed_;
  Buffer passed_;  ///< bits of the voxels that hide what the sweep comes to, for rays
  Buffer uniforms_{sizeof(shaders::SweepParameters)};
  std::vector<std::uint32_t> columns_of_layer_;
  Direction direction_{};
  shaders::SweepParameters parameters_{};
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

SparseVolume carve(gpu::Context& context, const SparseVolume& hull, Resampling resampling,
                   std::span<const Camera> cameras, const PhotoOptions& options, Progress& progress,
                   PhotoReport* report) {
  const char* sampling = resampling.name;
  const double sampled_before = context.statistics()[sampling].seconds;
  Sweeper sweeper(context, hull, std::move(resampling), cameras, options);
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
    report->sampling_seconds = context.statistics()[sampling].seconds - sampled_before;
  }
  return carved_distance(hull, sweeper.result());
}

}  // namespace

SparseVolume carve_photo(gpu::Context& context, const SparseVolume& hull,
                         const projtex::ImageSet& images, std::span<const Camera> cameras,
                         const PhotoOptions& options, Progress& progress, PhotoReport* report) {
  options.validate();
  PHOTOHULL_CHECK_OP(int(cameras.size()), ==, images.layers());
  Resampling resampling{"projtex_project_layer",
                        Program::compute(context, "projtex_project_layer.comp.glsl",
                                         concat("#define SUPERSAMPLE ", options.supersample, "\n") +
                                             search_defines(search_disc(options.search_radius))),
                        [&images](const Program&) { images.texture().bind(shaders::kImagesUnit); },
                        {images.texture().width(), images.texture().height()},
                        false};
  return carve(context, hull, std::move(resampling), cameras, options, progress, report);
}

SparseVolume carve_photo(gpu::Context& context, const SparseVolume& hull,
                         const projtex::SampleImages& images, std::span<const Camera> cameras,
                         const PhotoOptions& options, Progress& progress, PhotoReport* report) {
  options.validate();
  PHOTOHULL_CHECK_OP(int(cameras.size()), ==, images.layers());
  Resampling resampling{
      "projtex_sample_layer",
      images.program(context, "projtex_sample_layer.comp.glsl", options.supersample,
                     search_defines(search_disc(options.search_radius))),
      [&images](const Program& program) { images.bind(program); }, images.size(), true};
  return carve(context, hull, std::move(resampling), cameras, options, progress, report);
}

}  // namespace photohull::carving
