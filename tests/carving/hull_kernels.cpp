#include "carving/hull_kernels.h"

#include <Imath/half.h>

#include <algorithm>
#include <numeric>

#include "carving/mask_pyramid.h"
#include "projtex/gpu_views.h"
#include "support/filtering.h"

namespace photohull::carving::test_kernels {

double distance_bound() { return 2e-3 + 2 * test::filtering_error(); }

std::vector<Silhouette> HullScene::silhouettes() const {
  std::vector<Silhouette> out;
  for (const test::Outline& o : outlines)
    out.push_back(o.mask.empty() ? Silhouette{} : Silhouette{&o.mask, &o.distance});
  return out;
}

double HullScene::distance(const glm::ivec3& voxel) const {
  return reference::hull_distance({grid, box}, {cameras, silhouettes()}, options, voxel);
}

HullKernels::HullKernels(gpu::Context& context, const HullScene& scene, bool in_storage)
    : context_(context),
      scene_(scene),
      words_(int(scene.cameras.size() + 31) / 32),
      in_storage_(in_storage) {
  const int count = int(scene.cameras.size());
  const glm::ivec2 size = projtex::array_size(scene.cameras);
  const MaskPyramid shape = build_mask_pyramid({}, size.x, size.y);
  pyramid_ = gpu::TextureArray(gpu::TextureFormat::kRg8, shape.width, shape.height, count, 0);
  distance_maps_ = gpu::TextureArray(gpu::TextureFormat::kR16f, size.x, size.y, count);
  std::vector<shaders::GpuView> views;
  for (int i = 0; i < count; ++i) {
    const Intrinsics& k = scene.cameras[i].intrinsics;
    upload(i, scene.outlines[i].mask.empty()
                  ? test::rasterise(k.width, k.height, [](const glm::dvec2&) { return -32768.0; })
                  : scene.outlines[i]);
    views.push_back(projtex::to_gpu_view(projtex::to_grid(scene.cameras[i], scene.grid), size));
  }
  stored_views_ = gpu::Buffer::of(views);
  device_views_.emplace(views);
  const auto to_voxels = [&](const glm::dvec3& p) {
    return glm::vec4(glm::vec3((p - scene.grid.origin) / scene.grid.voxel_size), 0);
  };
  parameters_.box_min = to_voxels(scene.box.min);
  parameters_.box_max = to_voxels(scene.box.max);
  parameters_.counts = {0, count, words_, scene.options.min_views};
  parameters_.pyramid = {MaskPyramid::kBlock, shape.levels.size(), 0, SparseVolume::kBand};
  parameters_.limits = {scene.options.views_may_miss, 0, 0, 0};
  parameters_.evidence = {float(scene.options.full_evidence), 0, 0, 0};
}

void HullKernels::upload(int view, const test::Outline& outline) {
  const MaskPyramid pyramid =
      build_mask_pyramid(outline.mask, distance_maps_.width(), distance_maps_.height());
  for (int level = 0; level < int(pyramid.levels.size()); ++level)
    pyramid_.upload(view, std::max(pyramid.width >> level, 1), std::max(pyramid.height >> level, 1),
                    pyramid.levels[level].data(), level);
  // Smaller images repeat their border, since look-ups reach half a pixel beyond its centres.
  const SilhouetteDistance& d = outline.distance;
  std::vector<std::uint16_t> padded;
  for (int y = 0; y < distance_maps_.height(); ++y)
    for (int x = 0; x < distance_maps_.width(); ++x)
      padded.push_back(
          half(
              d.pixels[std::size_t(std::min(y, d.height - 1)) * d.width + std::min(x, d.width - 1)])
              .bits());
  distance_maps_.upload(view, distance_maps_.width(), distance_maps_.height(), padded.data());
}

void HullKernels::bind_views() const {
  if (in_storage_)
    stored_views_.bind_storage(shaders::kViewsBinding);
  else
    device_views_->bind();
}

std::vector<std::uint32_t> HullKernels::classify(const std::vector<glm::ivec4>& nodes,
                                                 float margin) {
  parameters_.counts.x = int(nodes.size());
  parameters_.pyramid.z = margin;
  const gpu::Buffer parameters(sizeof parameters_, &parameters_);
  const gpu::Buffer node_buffer = gpu::Buffer::of(nodes), classes(nodes.size() * 4);
  const gpu::Buffer relevant(nodes.size() * 4 * words_);
  parameters.bind_uniform(shaders::kHullParametersBinding);
  bind_views();
  node_buffer.bind_storage(shaders::kHullNodesBinding);
  classes.bind_storage(shaders::kHullClassesBinding);
  relevant.bind_storage(shaders::kHullRelevantBinding);
  pyramid_.bind(shaders::kMaskPyramidUnit);
  distance_maps_.bind(shaders::kNodeSilhouettesUnit);
  gpu::Program::compute(context_, "carving_classify_nodes.comp.glsl", defines())
      ->dispatch(context_, "carving_classify_nodes", gpu::group_count(nodes.size(), 64));
  std::vector<std::uint32_t> kinds = classes.download<std::uint32_t>(nodes.size());
  for (std::uint32_t& kind : kinds) kind &= shaders::kNodeKindMask;
  return kinds;
}

std::vector<float> HullKernels::distances(const std::vector<glm::ivec4>& bricks) {
  const std::size_t count = bricks.size(), views = scene_.cameras.size();
  std::vector<std::uint32_t> lists(count + 1 + count * views);
  for (std::size_t i = 0; i <= count; ++i) lists[i] = std::uint32_t(count + 1 + i * views);
  for (std::size_t i = 0; i < count; ++i)
    std::iota(lists.begin() + lists[i], lists.begin() + lists[i] + long(views), 0u);
  parameters_.counts.x = int(count);
  const gpu::Buffer parameters(sizeof parameters_, &parameters_);
  // Every brick is treated as one that too few views may see.
  std::vector<glm::ivec4> unsure = bricks;
  for (glm::ivec4& brick : unsure) brick.w = 1;
  const gpu::Buffer brick_buffer = gpu::Buffer::of(unsure), list_buffer = gpu::Buffer::of(lists);
  const gpu::Buffer out(count * kBrickVoxels * 4);
  parameters.bind_uniform(shaders::kHullParametersBinding);
  bind_views();
  brick_buffer.bind_storage(shaders::kHullBricksBinding);
  out.bind_storage(shaders::kHullDistancesBinding);
  list_buffer.bind_storage(shaders::kHullViewListsBinding);
  distance_maps_.bind(shaders::kBrickSilhouettesUnit);
  gpu::Program::compute(context_, "carving_hull_distance.comp.glsl", defines())
      ->dispatch(context_, "carving_hull_distance", count);
  return out.download<float>(count * kBrickVoxels);
}

}  // namespace photohull::carving::test_kernels
