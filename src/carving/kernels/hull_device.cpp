#include "carving/kernels/hull_device.h"

#include <algorithm>

#include "carving/mask_pyramid.h"
#include "core/error.h"
#include "projtex/gpu_views.h"
#include "shared/hull.h"

namespace photohull::carving {
namespace {

using glm::ivec4;
using gpu::Buffer;

static_assert(HullOptions::kMostMissing == shaders::kMostMissing);

constexpr std::size_t kBatchBricks = 16384;  // 32 MiB of distances a dispatch
constexpr std::size_t kBatchNodes = std::size_t(1) << 20;

std::vector<shaders::GpuView> views_of(const HullSpace& space,
                                       const SilhouetteTextures& silhouettes) {
  std::vector<shaders::GpuView> out;
  for (const Camera& camera : silhouettes.cameras())
    out.push_back(projtex::to_gpu_view(projtex::to_grid(camera, space.grid), silhouettes.size()));
  return out;
}

}  // namespace

HullDevice::HullDevice(gpu::Context& context, const HullSpace& space,
                       const SilhouetteTextures& silhouettes, const HullOptions& options)
    : context_(context),
      space_(space),
      silhouettes_(silhouettes),
      options_(options),
      views_(int(silhouettes.cameras().size())),
      words_((views_ + 31) / 32),
      device_views_(views_of(space, silhouettes)),
      classify_(gpu::Program::compute(context, "carving_classify_nodes.comp.glsl",
                                      device_views_.defines())),
      distance_(gpu::Program::compute(context, "carving_hull_distance.comp.glsl",
                                      device_views_.defines())) {
  PHOTOHULL_CHECK(options.views_may_miss >= 0 &&
                  options.views_may_miss <= HullOptions::kMostMissing);
  PHOTOHULL_CHECK(options.full_evidence >= 0);
  PHOTOHULL_CHECK(options.full_evidence == 0 || options.views_may_miss == 0);
}

gpu::Buffer HullDevice::bind_parameters(std::size_t items) const {
  const GridSpec& grid = space_.grid;
  const auto to_voxels = [&](const glm::dvec3& p) {
    return glm::vec4(glm::vec3((p - grid.origin) / grid.voxel_size), 0);
  };
  shaders::HullParameters p{};
  p.box_min = to_voxels(space_.box.min);
  p.box_max = to_voxels(space_.box.max);
  p.counts = {int(items), views_, words_, options_.min_views};
  p.limits = {options_.views_may_miss, 0, 0, 0};
  p.evidence = {float(options_.full_evidence), 0, 0, 0};
  p.pyramid = {MaskPyramid::kBlock, silhouettes_.levels(), kSplitMargin, SparseVolume::kBand};
  Buffer parameters(sizeof p, &p);
  parameters.bind_uniform(shaders::kHullParametersBinding);
  device_views_.bind();
  return parameters;
}

ClassifiedNodes HullDevice::classify(std::span<const HullNode> nodes) const {
  ClassifiedNodes out;
  const std::size_t batch =
      gpu::batch_size(std::max<std::size_t>(sizeof(ivec4), 4 * words_), kBatchNodes);
  for (std::size_t first = 0; first < nodes.size(); first += batch)
    classify_batch(nodes.subspan(first, std::min(batch, nodes.size() - first)), out);
  return out;
}

void HullDevice::classify_batch(std::span<const HullNode> nodes, ClassifiedNodes& out) const {
  std::vector<ivec4> places;
  places.reserve(nodes.size());
  for (const HullNode& node : nodes) places.emplace_back(node.place, node.level);
  const Buffer node_buffer = Buffer::of(places);
  const Buffer classes(nodes.size() * 4), relevant(nodes.size() * 4 * words_);
  const Buffer parameters = bind_parameters(nodes.size());
  silhouettes_.pyramid().bind(shaders::kMaskPyramidUnit);
  silhouettes_.distances().bind(shaders::kNodeSilhouettesUnit);
  node_buffer.bind_storage(shaders::kHullNodesBinding);
  classes.bind_storage(shaders::kHullClassesBinding);
  relevant.bind_storage(shaders::kHullRelevantBinding);
  classify_->dispatch(context_, "carving_classify_nodes", gpu::group_count(nodes.size(), 64));
  const auto kinds = classes.download<std::uint32_t>(nodes.size());
  const auto bits = relevant.download<std::uint32_t>(nodes.size() * words_);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::uint32_t kind = kinds[i] & shaders::kNodeKindMask;
    if (kind == shaders::kNodeInside) out.inside.push_back(nodes[i]);
    if (kind != shaders::kNodeSurface) continue;
    out.unsure.push_back((kinds[i] & shaders::kNodeUnsure) != 0);
    out.surface.push_back(nodes[i]);
    out.relevant.insert(out.relevant.end(), bits.begin() + long(i * words_),
                        bits.begin() + long((i + 1) * words_));
  }
}

std::size_t HullDevice::brick_batch() const {
  const std::size_t bytes = std::max<std::size_t>(kBrickVoxels * 4, 4 * (views_ + 1));
  return gpu::batch_size(bytes, kBatchBricks);
}

/// Offsets of `count` + 1 lists, then the lists.
std::vector<std::uint32_t> HullDevice::view_lists(const ClassifiedNodes& bricks, std::size_t first,
                                                  std::size_t count) const {
  std::vector<std::uint32_t> out(count + 1);
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = std::uint32_t(out.size());
    for (int v = 0; v < views_; ++v)
      if (bricks.relevant[(first + i) * words_ + v / 32] >> (v % 32) & 1)
        out.push_back(std::uint32_t(v));
  }
  out[count] = std::uint32_t(out.size());
  return out;
}

std::vector<float> HullDevice::distances(const ClassifiedNodes& bricks, std::size_t first,
                                         std::size_t count) const {
  std::vector<ivec4> flagged;
  for (std::size_t i = first; i < first + count; ++i)
    flagged.emplace_back(bricks.surface[i].place, int(bricks.unsure[i]));
  const Buffer brick_buffer = Buffer::of(flagged);
  const Buffer relevant = Buffer::of(view_lists(bricks, first, count));
  const Buffer found(count * kBrickVoxels * 4);
  const Buffer parameters = bind_parameters(count);
  silhouettes_.distances().bind(shaders::kBrickSilhouettesUnit);
  brick_buffer.bind_storage(shaders::kHullBricksBinding);
  found.bind_storage(shaders::kHullDistancesBinding);
  relevant.bind_storage(shaders::kHullViewListsBinding);
  distance_->dispatch(context_, "carving_hull_distance", count);
  return found.download<float>(count * kBrickVoxels);
}

}  // namespace photohull::carving
