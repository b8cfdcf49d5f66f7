#include "carving/sweep_kernels.h"

#include <algorithm>

#include "carving/kernels/read_decisions.h"

namespace photohull::carving::test_kernels {
namespace {

using glm::ivec3;
using gpu::Buffer;

std::vector<shaders::GpuView> to_gpu(const std::vector<projtex::GridCamera>& cameras) {
  std::vector<shaders::GpuView> views;
  for (const projtex::GridCamera& c : cameras) views.push_back(to_gpu_view(c, {64, 64}));
  return views;
}

/// An empty list with room for `capacity` entries of 16 or 32 bytes after its header.
Buffer list_of(std::size_t capacity, std::size_t entry_bytes) {
  Buffer list(16 + capacity * entry_bytes);
  list.fill(0);
  return list;
}

}  // namespace

SweepKernels::SweepKernels(gpu::Context& context, const BitVolume& bits,
                           const reference::SweepFrame& frame,
                           const std::vector<projtex::GridCamera>& cameras,
                           const std::string& score_defines, int shifts)
    : context_(context),
      frame_(frame),
      bricks_(bits.grid.bricks),
      view_count_(int(cameras.size())),
      shifts_(shifts),
      select_(gpu::Program::compute(context, "carving_select_columns.comp.glsl")),
      score_(gpu::Program::compute(context, "carving_score_columns.comp.glsl", score_defines)),
      update_(gpu::Program::compute(context, "carving_update_columns.comp.glsl")),
      mark_(gpu::Program::compute(context, "carving_mark_passed.comp.glsl")),
      maps_(cameras, bits.grid),
      views_(Buffer::of(to_gpu(cameras))),
      table_(Buffer::of(bits.table)),
      occupancy_(Buffer::of(bits.words)),
      active_(bits.table.size() * 4),
      passed_(bits.words.size() * 4),
      uniforms_(sizeof parameters),
      by_rays_(score_defines.find("SWEEP_RAYS") != std::string::npos) {
  const std::size_t columns =
      std::size_t(frame.voxels[frame.u()]) * std::size_t(frame.voxels[frame.v()]);
  columns_ = Buffer::of(std::vector<shaders::Column>(columns, {{-1, -1, 0, 0}, glm::vec4(0)}));
  decisions_ = list_of(columns * std::size_t(frame.voxels[frame.axis]), sizeof(shaders::Decision));
  active_.fill(0);
  passed_.fill(0);
  parameters.axes = {frame.u(), frame.v(), frame.axis, frame.sign};
}

void SweepKernels::set_parameters() {
  parameters.chunk.x = parameters.chunk.z = 0;
  parameters.chunk.w = int(judged_.size());
  uniforms_.write(0, sizeof parameters, &parameters);
  uniforms_.bind_uniform(shaders::kSweepParametersBinding);
}

SelectedLayer SweepKernels::select(int layer) {
  std::vector<shaders::LayerItem> items;
  const int u = frame_.u(), v = frame_.v();
  ivec3 brick = frame_.voxel({0, 0}, layer) / kBrickEdge;
  for (brick[v] = 0; brick[v] < bricks_[v]; ++brick[v])
    for (brick[u] = 0; brick[u] < bricks_[u]; ++brick[u]) {
      shaders::LayerItem item{};
      item.brick = glm::ivec4(brick, view_count_);
      for (int i = 0; i < view_count_; ++i) item.views[i / 4][i % 4] = unsigned(i);
      items.push_back(item);
    }
  parameters.bricks = glm::ivec4(bricks_, int(items.size()));
  parameters.layer.x = layer;
  items_ = Buffer::of(items);
  selected_ = list_of(items.size(), 16);
  occluders_ = list_of(items.size() * 128, 16);
  judged_.clear();
  set_parameters();
  items_.bind_storage(shaders::kSweepItemsBinding);
  selected_.bind_storage(shaders::kSweepSelectedBinding);
  table_.bind_storage(shaders::kSweepTableBinding);
  occupancy_.bind_storage(shaders::kSweepOccupancyBinding);
  occluders_.bind_storage(shaders::kOccludersBinding);
  columns_.bind_storage(shaders::kSweepColumnsBinding);
  select_->dispatch(context_, "carving_select_columns", items.size());

  const std::uint32_t count = selected_.download<std::uint32_t>(1)[0];
  entries_ = selected_.download<glm::uvec4>(count, 1);
  std::sort(entries_.begin(), entries_.end(),
            [](const glm::uvec4& a, const glm::uvec4& b) { return a.x < b.x; });
  selected_.write(16, entries_.size() * 16, entries_.data());
  SelectedLayer out;
  for (std::size_t entry = 0; entry < entries_.size(); ++entry)
    for (int column = 0; column < 64; ++column) {
      if (!(entries_[entry][1 + column / 32] >> (column % 32) & 1)) continue;
      const std::uint32_t item = entries_[entry].x;
      const glm::ivec4 b = items[item].brick;
      out.judged.push_back(glm::ivec2(b[u], b[v]) * kBrickEdge +
                           glm::ivec2(column % 8, column / 8));
      judged_.push_back({std::uint32_t(entry), item, out.judged.back().x, out.judged.back().y});
    }
  out.occluders = occluders();
  packed_ = Buffer::of(judged_);
  scores_ = Buffer(judged_.size() * 16);
  return out;
}

void SweepKernels::mark(const Buffer& voxels, std::size_t count) {
  set_parameters();
  table_.bind_storage(shaders::kSweepTableBinding);
  passed_.bind_storage(shaders::kSweepPassedBinding);
  voxels.bind_storage(shaders::kOccludersBinding);
  mark_->dispatch(context_, "carving_mark_passed", gpu::group_count(count, 64));
}

std::vector<glm::vec4> SweepKernels::score(const std::vector<glm::vec4>& samples) {
  const Buffer sample_buffer = Buffer::of(samples);
  set_parameters();
  views_.bind_storage(shaders::kViewsBinding);
  items_.bind_storage(shaders::kSweepItemsBinding);
  packed_.bind_storage(shaders::kSweepSelectedColumnsBinding);
  scores_.bind_storage(shaders::kSweepScoresBinding);
  if (by_rays_) {
    table_.bind_storage(shaders::kSweepTableBinding);
    passed_.bind_storage(shaders::kSweepPassedBinding);
  } else {
    maps_.bind();
  }
  sample_buffer.bind_storage(shaders::kSweepSamplesBinding);
  score_->dispatch(context_, "carving_score_columns", gpu::group_count(judged_.size(), 64));
  return scores_.download<glm::vec4>(judged_.size());
}

void SweepKernels::update(const std::vector<glm::vec4>& scores) {
  scores_ = Buffer::of(scores);
  set_parameters();
  active_.bind_storage(shaders::kSweepActiveBinding);
  decisions_.bind_storage(shaders::kSweepDecisionsBinding);
  packed_.bind_storage(shaders::kSweepSelectedColumnsBinding);
  scores_.bind_storage(shaders::kSweepScoresBinding);
  table_.bind_storage(shaders::kSweepTableBinding);
  occupancy_.bind_storage(shaders::kSweepOccupancyBinding);
  occluders_.bind_storage(shaders::kOccludersBinding);
  columns_.bind_storage(shaders::kSweepColumnsBinding);
  update_->dispatch(context_, "carving_update_columns", gpu::group_count(judged_.size(), 64));
}

std::size_t SweepKernels::patch_base(std::size_t judged, int view, int shift) const {
  const shaders::SelectedColumn& column = judged_[judged];
  const std::size_t place = std::size_t(column.brick) * shaders::kMaxLayerViews + std::size_t(view);
  return (place * std::size_t(shifts_) + std::size_t(shift)) * shaders::kApronArea +
         std::size_t(column.v % 8 * shaders::kApronEdge + column.u % 8);
}

std::vector<std::uint8_t> SweepKernels::on_path() const {
  std::vector<std::uint8_t> out;
  for (const shaders::Column& column :
       columns_.download<shaders::Column>(columns_.bytes() / sizeof(shaders::Column)))
    out.push_back(column.path.x >= 0);
  return out;
}

std::vector<Decision> SweepKernels::decisions() const {
  std::vector<Decision> out;
  read_decisions(decisions_, out);
  return out;
}

std::vector<ivec3> SweepKernels::occluders() const {
  const std::uint32_t count = occluders_.download<std::uint32_t>(1)[0];
  std::vector<ivec3> out;
  for (const glm::ivec4& voxel : occluders_.download<glm::ivec4>(count, 1)) out.emplace_back(voxel);
  return out;
}

std::uint32_t SweepKernels::judged_count() const {
  return decisions_.download<std::uint32_t>(2)[1];
}

}  // namespace photohull::carving::test_kernels
