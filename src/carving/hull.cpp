// Based on: A. Laurentini, "The visual hull concept", PAMI 1994; the coarse-to-fine sweep is that
// of R. Szeliski, "Rapid octree construction from image sequences", CVGIP 1993, on bricks.
#include "carving/hull.h"

#include <algorithm>
#include <bit>

#include "carving/mask_pyramid.h"
#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/texture.h"
#include "projtex/gpu_views.h"
#include "shared/hull.h"

namespace photohull::carving {
namespace {

using glm::ivec3;
using glm::ivec4;
using gpu::Buffer;

constexpr float kSplitMargin = 1.0f;         // voxels: keeps both ends of every sign change stored
constexpr std::size_t kBatchBricks = 16384;  // 32 MiB of distances a dispatch
constexpr std::size_t kBatchNodes = std::size_t(1) << 20;

/// Everything the kernels need of the silhouettes, on the device.
struct DeviceSilhouettes {
  gpu::TextureArray pyramid;
  gpu::TextureArray distances;
  Buffer views;
  int levels = 0;
};

/// Repeats the border beyond the image: samples half a pixel outside must not meet foreign values.
void pad_distances(const SilhouetteDistance* d, const glm::ivec2& size, std::vector<float>& out) {
  out.assign(std::size_t(size.x) * size.y, -SilhouetteDistance::kNoContour);
  for (int y = 0; d && y < size.y; ++y) {
    const float* row = &d->pixels[std::size_t(std::min(y, d->height - 1)) * d->width];
    float* target = &out[std::size_t(y) * size.x];
    std::copy(row, row + d->width, target);
    std::fill(target + d->width, target + size.x, row[d->width - 1]);
  }
}

DeviceSilhouettes upload(const GridSpec& grid, std::span<const Camera> cameras,
                         std::span<const Silhouette> silhouettes) {
  const glm::ivec2 size = projtex::array_size(cameras);
  DeviceSilhouettes out;
  out.distances = gpu::TextureArray(gpu::TextureFormat::kR16f, size.x, size.y, int(cameras.size()));
  std::vector<shaders::GpuView> views;
  std::vector<float> padded;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const Intrinsics& k = cameras[i].intrinsics;
    Mask whole;
    const Mask* mask = silhouettes[i].mask;
    if (!mask || mask->empty()) {
      whole = {k.width, k.height, std::vector<std::uint8_t>(std::size_t(k.width) * k.height, 255)};
      mask = &whole;
    }
    const MaskPyramid pyramid = build_mask_pyramid(*mask, size.x, size.y);
    if (i == 0) {
      out.levels = int(pyramid.levels.size());
      out.pyramid = gpu::TextureArray(gpu::TextureFormat::kRg8, pyramid.width, pyramid.height,
                                      int(cameras.size()), 0);
    }
    for (int level = 0; level < out.levels; ++level)
      out.pyramid.upload(int(i), std::max(pyramid.width >> level, 1),
                         std::max(pyramid.height >> level, 1), pyramid.levels[level].data(), level);
    const SilhouetteDistance* d = silhouettes[i].distance;
    PHOTOHULL_CHECK(!d || (d->width == k.width && d->height == k.height));
    pad_distances(d, size, padded);
    out.distances.upload(int(i), size.x, size.y, padded.data());
    views.push_back(projtex::to_gpu_view(projtex::to_grid(cameras[i], grid), size));
  }
  out.views = Buffer::of(views);
  return out;
}

struct Classified {
  std::vector<ivec4> surface;           ///< nodes to split or, at level 0, bricks to evaluate
  std::vector<std::uint32_t> relevant;  ///< view bit sets of `surface`
  std::vector<std::uint8_t> unsure;     ///< of `surface`: too few views show all of it
  std::vector<ivec4> inside;
};

class HullCarver {
 public:
  HullCarver(gpu::Context& context, const GridSpec& grid, const Box& box,
             std::span<const Camera> cameras, std::span<const Silhouette> silhouettes,
             const HullOptions& options)
      : context_(context),
        grid_(grid),
        views_(int(cameras.size())),
        words_((views_ + 31) / 32),
        device_(upload(grid, cameras, silhouettes)),
        classify_(gpu::Program::compute(context, "carving_classify_nodes.comp.glsl")),
        distance_(gpu::Program::compute(context, "carving_hull_distance.comp.glsl")) {
    const auto to_voxels = [&](const glm::dvec3& p) {
      return glm::vec4(glm::vec3((p - grid.origin) / grid.voxel_size), 0);
    };
    parameters_.box_min = to_voxels(box.min);
    parameters_.box_max = to_voxels(box.max);
    parameters_.counts = {0, views_, words_, options.min_views};
    static_assert(HullOptions::kMostMissing == shaders::kMostMissing);
    PHOTOHULL_CHECK(options.views_may_miss >= 0 &&
                    options.views_may_miss <= HullOptions::kMostMissing);
    PHOTOHULL_CHECK(options.full_evidence >= 0);
    PHOTOHULL_CHECK(options.full_evidence == 0 || options.views_may_miss == 0);
    parameters_.limits = {options.views_may_miss, 0, 0, 0};
    parameters_.evidence = {float(options.full_evidence), 0, 0, 0};
    parameters_.pyramid = {MaskPyramid::kBlock, device_.levels, kSplitMargin, SparseVolume::kBand};
  }

  /// Nodes of the coarsest level whose 8 voxels times 2^level cover the grid a few times a side.
  std::vector<ivec4> root_nodes() const {
    const int longest = std::max({grid_.bricks.x, grid_.bricks.y, grid_.bricks.z});
    const int level = std::max(0, int(std::bit_width(unsigned(longest))) - 3);
    std::vector<ivec4> nodes;
    const ivec3 count = (grid_.bricks + (1 << level) - 1) / (1 << level);
    for (int z = 0; z < count.z; ++z)
      for (int y = 0; y < count.y; ++y)
        for (int x = 0; x < count.x; ++x) nodes.push_back({x, y, z, level});
    return nodes;
  }

  Classified classify(const std::vector<ivec4>& nodes) {
    Classified out;
    const std::size_t batch =
        gpu::batch_size(std::max<std::size_t>(sizeof(ivec4), 4 * words_), kBatchNodes);
    for (std::size_t first = 0; first < nodes.size(); first += batch)
      classify(std::span(nodes).subspan(first, std::min(batch, nodes.size() - first)), out);
    return out;
  }

  /// Bricks whose distances and lists of views fit into storage blocks.
  std::size_t brick_batch() const {
    const std::size_t bytes = std::max<std::size_t>(kBrickVoxels * 4, 4 * (views_ + 1));
    return gpu::batch_size(bytes, kBatchBricks);
  }

  /// The children that lie on the grid.
  std::vector<ivec4> split(const std::vector<ivec4>& nodes) const {
    std::vector<ivec4> children;
    children.reserve(nodes.size() * 8);
    for (const ivec4& n : nodes)
      for (int i = 0; i < 8; ++i) {
        const ivec3 child = ivec3(n) * 2 + ivec3(i & 1, (i >> 1) & 1, i >> 2);
        const ivec3 low = child << (n.w - 1);
        if (low.x < grid_.bricks.x && low.y < grid_.bricks.y && low.z < grid_.bricks.z)
          children.emplace_back(child, n.w - 1);
      }
    return children;
  }

  /// Offsets of `count` + 1 lists, then the lists of the views that matter to each brick.
  std::vector<std::uint32_t> view_lists(const Classified& leaves, std::size_t first,
                                        std::size_t count) const {
    std::vector<std::uint32_t> out(count + 1);
    for (std::size_t i = 0; i < count; ++i) {
      out[i] = std::uint32_t(out.size());
      for (int v = 0; v < views_; ++v)
        if (leaves.relevant[(first + i) * words_ + v / 32] >> (v % 32) & 1)
          out.push_back(std::uint32_t(v));
    }
    out[count] = std::uint32_t(out.size());
    return out;
  }

  /// Distances of the bricks [first, first + count) of the last level.
  std::vector<float> evaluate(const Classified& leaves, std::size_t first, std::size_t count) {
    std::vector<ivec4> flagged(leaves.surface.begin() + long(first),
                               leaves.surface.begin() + long(first + count));
    for (std::size_t i = 0; i < count; ++i) flagged[i].w = leaves.unsure[first + i];
    Buffer bricks = Buffer::of(flagged);
    Buffer relevant = Buffer::of(view_lists(leaves, first, count));
    Buffer distances(count * kBrickVoxels * 4);
    parameters_.counts.x = int(count);
    Buffer parameters(sizeof parameters_, &parameters_);
    bind(parameters);
    device_.distances.bind(shaders::kBrickSilhouettesUnit);
    bricks.bind_storage(shaders::kHullBricksBinding);
    distances.bind_storage(shaders::kHullDistancesBinding);
    relevant.bind_storage(shaders::kHullViewListsBinding);
    distance_->dispatch(context_, "carving_hull_distance", count);
    return distances.download<float>(count * kBrickVoxels);
  }

 private:
  void classify(std::span<const ivec4> nodes, Classified& out) {
    const Buffer node_buffer = Buffer::of(nodes);
    Buffer classes(nodes.size() * 4), relevant(nodes.size() * 4 * words_);
    parameters_.counts.x = int(nodes.size());
    Buffer parameters(sizeof parameters_, &parameters_);
    bind(parameters);
    device_.pyramid.bind(shaders::kMaskPyramidUnit);
    device_.distances.bind(shaders::kNodeSilhouettesUnit);
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

  void bind(const Buffer& parameters) const {
    parameters.bind_uniform(shaders::kHullParametersBinding);
    device_.views.bind_storage(shaders::kViewsBinding);
  }

  gpu::Context& context_;
  GridSpec grid_;
  int views_, words_;
  DeviceSilhouettes device_;
  std::shared_ptr<const gpu::Program> classify_, distance_;
  shaders::HullParameters parameters_;
};

void mark_inside(SparseVolume& volume, const ivec4& node) {
  const ivec3 low = ivec3(node) << node.w;
  const ivec3 high = glm::min(low + (1 << node.w), volume.grid.bricks);
  for (int z = low.z; z < high.z; ++z)
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x)
        volume.table[volume.grid.brick_index({x, y, z})] = SparseVolume::kInside;
}

/// Stores a brick unless all of it lies on one side, beyond the reach of interpolation.
void store_brick(SparseVolume& volume, const ivec3& brick, const float* distances) {
  const auto [low, high] = std::minmax_element(distances, distances + kBrickVoxels);
  std::uint32_t& slot = volume.table[volume.grid.brick_index(brick)];
  if (*low > kSplitMargin || *high < -kSplitMargin) {
    slot = *low > 0 ? SparseVolume::kOutside : SparseVolume::kInside;
    return;
  }
  slot = std::uint32_t(volume.bricks.size());
  volume.bricks.push_back(brick);
  volume.distance.insert(volume.distance.end(), distances, distances + kBrickVoxels);
  for (std::size_t i = volume.distance.size() - kBrickVoxels; i < volume.distance.size(); ++i)
    volume.distance[i] = std::clamp(volume.distance[i], -SparseVolume::kBand, SparseVolume::kBand);
}

std::int64_t count_bits(const std::vector<std::uint32_t>& words) {
  std::int64_t count = 0;
  for (const std::uint32_t w : words) count += std::popcount(w);
  return count;
}

}  // namespace

SparseVolume carve_silhouette(gpu::Context& context, const GridSpec& grid, const Box& box,
                              std::span<const Camera> cameras,
                              std::span<const Silhouette> silhouettes, const HullOptions& options,
                              Progress& progress, HullReport* report) {
  PHOTOHULL_CHECK(!cameras.empty());
  PHOTOHULL_CHECK_OP(cameras.size(), ==, silhouettes.size());
  HullCarver carver(context, grid, box, cameras, silhouettes, options);
  SparseVolume volume;
  volume.grid = grid;
  volume.table.assign(grid.brick_count(), SparseVolume::kOutside);
  HullReport counts;

  std::vector<ivec4> nodes = carver.root_nodes();
  Classified found;
  for (;;) {
    progress.check_cancelled();
    counts.nodes_tested += std::int64_t(nodes.size());
    found = carver.classify(nodes);
    for (const ivec4& node : found.inside) mark_inside(volume, node);
    if (nodes.empty() || nodes.front().w == 0) break;
    nodes = carver.split(found.surface);
    if (nodes.empty()) break;
  }
  if (nodes.empty()) found.surface.clear();
  counts.bricks_evaluated = std::int64_t(found.surface.size());
  counts.samples = count_bits(found.relevant) * kBrickVoxels;
  const std::size_t batch = carver.brick_batch();
  for (std::size_t first = 0; first < found.surface.size(); first += batch) {
    progress.check_cancelled();
    const std::size_t count = std::min(batch, found.surface.size() - first);
    const std::vector<float> distances = carver.evaluate(found, first, count);
    for (std::size_t i = 0; i < count; ++i)
      store_brick(volume, ivec3(found.surface[first + i]), &distances[i * kBrickVoxels]);
    progress.update(double(first + count) / double(found.surface.size()));
  }
  if (report) *report = counts;
  return volume;
}

}  // namespace photohull::carving
