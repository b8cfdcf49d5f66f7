// Based on: A. Laurentini, "The visual hull concept", PAMI 1994; the coarse-to-fine sweep is that
// of R. Szeliski, "Rapid octree construction from image sequences", CVGIP 1993, on bricks.
#include "carving/hull.h"

#include <algorithm>
#include <bit>

#include "carving/kernels/hull_device.h"
#include "carving/silhouette_textures.h"
#include "core/error.h"

namespace photohull::carving {
namespace {

using glm::ivec3;

/// Nodes of the coarsest level whose 8 voxels times 2^level cover the grid a few times a side.
std::vector<HullNode> root_nodes(const GridSpec& grid) {
  const int longest = std::max({grid.bricks.x, grid.bricks.y, grid.bricks.z});
  const int level = std::max(0, int(std::bit_width(unsigned(longest))) - 3);
  std::vector<HullNode> nodes;
  const ivec3 count = (grid.bricks + (1 << level) - 1) / (1 << level);
  for (int z = 0; z < count.z; ++z)
    for (int y = 0; y < count.y; ++y)
      for (int x = 0; x < count.x; ++x) nodes.push_back({{x, y, z}, level});
  return nodes;
}

/// The children that lie on the grid.
std::vector<HullNode> split(const GridSpec& grid, const std::vector<HullNode>& nodes) {
  std::vector<HullNode> children;
  children.reserve(nodes.size() * 8);
  for (const HullNode& n : nodes)
    for (int i = 0; i < 8; ++i) {
      const ivec3 child = n.place * 2 + ivec3(i & 1, (i >> 1) & 1, i >> 2);
      const ivec3 low = child << (n.level - 1);
      if (low.x < grid.bricks.x && low.y < grid.bricks.y && low.z < grid.bricks.z)
        children.push_back({child, n.level - 1});
    }
  return children;
}

void mark_inside(SparseVolume& volume, const HullNode& node) {
  const ivec3 low = node.place << node.level;
  const ivec3 high = glm::min(low + (1 << node.level), volume.grid.bricks);
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

SparseVolume carve_silhouette(gpu::Context& context, const HullSpace& space, const HullViews& views,
                              const HullOptions& options, Progress& progress, HullReport* report) {
  return carve_silhouette(context, space, SilhouetteTextures(views), options, progress, report);
}

SparseVolume carve_silhouette(gpu::Context& context, const HullSpace& space,
                              const SilhouetteTextures& silhouettes, const HullOptions& options,
                              Progress& progress, HullReport* report) {
  const HullDevice device(context, space, silhouettes, options);
  SparseVolume volume;
  volume.grid = space.grid;
  volume.table.assign(space.grid.brick_count(), SparseVolume::kOutside);
  HullReport counts;

  std::vector<HullNode> nodes = root_nodes(space.grid);
  ClassifiedNodes found;
  for (;;) {
    progress.check_cancelled();
    counts.nodes_tested += std::int64_t(nodes.size());
    found = device.classify(nodes);
    for (const HullNode& node : found.inside) mark_inside(volume, node);
    if (nodes.empty() || nodes.front().level == 0) break;
    nodes = split(space.grid, found.surface);
    if (nodes.empty()) break;
  }
  if (nodes.empty()) found.surface.clear();
  counts.bricks_evaluated = std::int64_t(found.surface.size());
  counts.samples = count_bits(found.relevant) * kBrickVoxels;
  const std::size_t batch = device.brick_batch();
  for (std::size_t first = 0; first < found.surface.size(); first += batch) {
    progress.check_cancelled();
    const std::size_t count = std::min(batch, found.surface.size() - first);
    const std::vector<float> distances = device.distances(found, first, count);
    for (std::size_t i = 0; i < count; ++i)
      store_brick(volume, found.surface[first + i].place, &distances[i * kBrickVoxels]);
    progress.update(double(first + count) / double(found.surface.size()));
  }
  if (report) *report = counts;
  return volume;
}

}  // namespace photohull::carving
