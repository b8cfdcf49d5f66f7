#include "carving/kernels/sweep_device.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "carving/search_disc.h"

namespace photohull::carving {
namespace {

using gpu::Buffer;
using gpu::Program;

// Of the samples of a brick's part of a layer, at a search offset.
constexpr std::size_t kSampleBytes = shaders::kMaxLayerViews * shaders::kApronArea * 16;
constexpr std::size_t kChunk = 1024;  // bricks, at a search offset each, whose samples are held
// Of statistics whose confidence is 0 where there is too little evidence.
constexpr float kLeastConfidence = 1e-6f;

/// What all steps of all sweeps have in common.
shaders::SweepParameters parameters_of(const PhotoOptions& options) {
  shaders::SweepParameters p{};
  const float least_texture = float(std::pow(options.min_texture * options.noise_sigma, 2));
  // The confidence of a correlation is the texture.
  const bool correlation = options.statistic == Statistic::kZncc;
  p.noise = {float(options.noise_sigma * options.noise_sigma),
             correlation ? least_texture : kLeastConfidence, least_texture, 0};
  p.thresholds = {float(options.keep_score), float(options.better_by), float(options.min_views),
                  float(options.depth_bias)};
  return p;
}

std::vector<shaders::GpuView> views_of(std::span<const projtex::GridCamera> cameras,
                                       const glm::ivec2& size) {
  std::vector<shaders::GpuView> views;
  for (const auto& camera : cameras) views.push_back(projtex::to_gpu_view(camera, size));
  return views;
}

}  // namespace

SweepDevice::SweepDevice(gpu::Context& context, const BitVolume& bits,
                         std::span<const projtex::GridCamera> cameras, LayerSampling sampling,
                         const PhotoOptions& options)
    : context_(context),
      sampling_(std::move(sampling)),
      options_(options),
      bricks_(bits.grid.bricks),
      search_(search_disc(options.search_radius)),
      chunk_(gpu::batch_size(search_.size() * kSampleBytes,
                             std::max<std::size_t>(kChunk / search_.size(), 1))),
      maps_(cameras, bits.grid),
      views_(views_of(cameras, sampling_.size)),
      select_(Program::compute(context, "carving_select_columns.comp.glsl")),
      score_(Program::compute(context, "carving_score_columns.comp.glsl",
                              statistic_defines(options.statistic, sampling_.coverage) +
                                  search_defines(search_) + maps_.defines() + views_.defines() +
                                  visibility::sweep_test_defines(options.visibility))),
      update_(Program::compute(context, "carving_update_columns.comp.glsl")),
      mark_(Program::compute(context, "carving_mark_passed.comp.glsl")),
      uniforms_(sizeof(shaders::SweepParameters)) {
  table_ = Buffer::of(bits.table);
  set_standing(bits);
  passed_ = Buffer(std::max<std::size_t>(bits.words.size(), 4) * 4);
  set_active(std::vector<std::uint32_t>(bits.table.size()));
  samples_ = Buffer(chunk_ * search_.size() * kSampleBytes);
}

void SweepDevice::set_standing(const BitVolume& bits) { occupancy_ = Buffer::of(bits.words); }

std::vector<std::uint32_t> SweepDevice::active() const {
  return active_.download<std::uint32_t>(active_.bytes() / 4);
}

void SweepDevice::set_active(std::span<const std::uint32_t> active) {
  active_ = Buffer::of(active);
}

void SweepDevice::begin(const SweepDirection& direction) {
  direction_ = direction;
  maps_.clear();
  passed_.fill(0);
}

void SweepDevice::set_parameters(int layer, const BandWork& work, const Chunk& chunk) {
  shaders::SweepParameters p = parameters_of(options_);
  const int axis = direction_.axis;
  p.bricks = glm::ivec4(bricks_, int(work.bricks.size()));
  p.axes = {(axis + 1) % 3, (axis + 2) % 3, axis, direction_.sign};
  p.layer = {layer, work.band.first_row * kBrickEdge, 0, options_.front_face};
  p.chunk = {int(chunk.first_brick), options_.max_path, int(chunk.first_column),
             int(chunk.columns)};
  uniforms_.write(0, sizeof p, &p);
  uniforms_.bind_uniform(shaders::kSweepParametersBinding);
}

void SweepDevice::bind_selection(const BandWork& work) const {
  work.item_buffer.bind_storage(shaders::kSweepItemsBinding);
  work.selected.buffer.bind_storage(shaders::kSweepSelectedBinding);
  table_.bind_storage(shaders::kSweepTableBinding);
  occupancy_.bind_storage(shaders::kSweepOccupancyBinding);
  work.occluders.buffer.bind_storage(shaders::kOccludersBinding);
  work.band.columns.bind_storage(shaders::kSweepColumnsBinding);
}

void SweepDevice::bind_sampling(const BandWork& work) const {
  views_.bind();
  work.item_buffer.bind_storage(shaders::kSweepItemsBinding);
  work.selected.buffer.bind_storage(shaders::kSweepSelectedBinding);
  samples_.bind_storage(shaders::kSweepSamplesBinding);
}

void SweepDevice::bind_scoring(const BandWork& work) const {
  views_.bind();
  work.item_buffer.bind_storage(shaders::kSweepItemsBinding);
  packed_.bind_storage(shaders::kSweepSelectedColumnsBinding);
  work.scores.bind_storage(shaders::kSweepScoresBinding);
  if (is_by_rays()) {
    table_.bind_storage(shaders::kSweepTableBinding);
    passed_.bind_storage(shaders::kSweepPassedBinding);
  } else {
    maps_.bind();
  }
  samples_.bind_storage(shaders::kSweepSamplesBinding);
}

void SweepDevice::bind_update(const BandWork& work) const {
  active_.bind_storage(shaders::kSweepActiveBinding);
  work.decided.buffer.bind_storage(shaders::kSweepDecisionsBinding);
  packed_.bind_storage(shaders::kSweepSelectedColumnsBinding);
  work.scores.bind_storage(shaders::kSweepScoresBinding);
  table_.bind_storage(shaders::kSweepTableBinding);
  occupancy_.bind_storage(shaders::kSweepOccupancyBinding);
  work.occluders.buffer.bind_storage(shaders::kOccludersBinding);
  work.band.columns.bind_storage(shaders::kSweepColumnsBinding);
}

std::int64_t SweepDevice::judge_layer(int layer, BandWork& work) {
  work.selected.clear();
  work.occluders.clear();
  columns_of_layer_.clear();
  set_parameters(layer, work, {});
  bind_selection(work);
  select_->dispatch(context_, "carving_select_columns", work.bricks.size());
  const std::size_t count = pack_columns(work);
  std::size_t column = 0;
  std::int64_t samples = 0;
  for (std::size_t first = 0; first < count; first += chunk_) {
    const std::size_t end = std::min(first + chunk_, count), first_column = column;
    while (column < columns_of_layer_.size() && columns_of_layer_[column].brick < end) ++column;
    set_parameters(layer, work, {first, first_column, column - first_column});
    bind_sampling(work);
    sampling_.bind(*sampling_.program);
    sampling_.program->dispatch(context_, sampling_.launch, end - first, search_.size());
    bind_scoring(work);
    score_->dispatch(context_, "carving_score_columns",
                     gpu::group_count(column - first_column, 64));
    samples += std::int64_t(end - first) * shaders::kMaxLayerViews * shaders::kApronArea *
               options_.supersample * options_.supersample * std::int64_t(search_.size());
  }
  set_parameters(layer, work, {0, 0, columns_of_layer_.size()});
  bind_update(work);
  update_->dispatch(context_, "carving_update_columns",
                    gpu::group_count(columns_of_layer_.size(), 64));
  return samples;
}

void SweepDevice::hide_behind(int layer, const BandWork& work) {
  const std::size_t count = work.occluders.count();
  if (is_by_rays()) {
    set_parameters(layer, work, {});
    table_.bind_storage(shaders::kSweepTableBinding);
    passed_.bind_storage(shaders::kSweepPassedBinding);
    work.occluders.buffer.bind_storage(shaders::kOccludersBinding);
    mark_->dispatch(context_, "carving_mark_passed", gpu::group_count(count, 64));
  } else {
    views_.bind();
    maps_.splat(context_, work.occluders.buffer, count, views_.defines());
  }
}

/// Puts the selected bricks in the order of their items, so that a run never depends on the
/// device's scheduling, and lists their columns. Returns the number of bricks.
std::size_t SweepDevice::pack_columns(BandWork& work) {
  const std::size_t count = work.selected.count();
  auto entries = std::vector<glm::uvec4>(count);
  work.selected.buffer.read(16, count * 16, entries.data());
  std::sort(entries.begin(), entries.end(),
            [](const glm::uvec4& a, const glm::uvec4& b) { return a.x < b.x; });
  work.selected.buffer.write(16, count * 16, entries.data());
  const int u = (direction_.axis + 1) % 3, v = (direction_.axis + 2) % 3;
  for (std::size_t entry = 0; entry < count; ++entry) {
    const glm::ivec3 origin = work.bricks[entries[entry].x] * kBrickEdge;
    for (int column = 0; column < 64; ++column)
      if (entries[entry][1 + column / 32] >> (column % 32) & 1)
        columns_of_layer_.push_back({std::uint32_t(entry), entries[entry].x,
                                     origin[u] + column % kBrickEdge,
                                     origin[v] + column / kBrickEdge});
  }
  packed_ = Buffer::of(columns_of_layer_);
  return count;
}

}  // namespace photohull::carving
