#include "carving/kernels/sweep_bands.h"

#include <algorithm>

#include "gpu/limits.h"
#include "shared/sweep.h"

namespace photohull::carving {
namespace {

// Of a brick in its list of decisions, which is the longest that the sweep has: two for each.
constexpr std::size_t kDecidedEntries = kBrickVoxels * 2;
static_assert(kDecidedEntries * 16 == kBrickVoxels * sizeof(shaders::Decision));
static_assert(kDecidedEntries * 16 >= 64 * sizeof(shaders::Column));

static_assert(LayerItem::kMostViews == shaders::kMaxLayerViews);

gpu::Buffer to_device(std::span<const LayerItem> items) {
  std::vector<shaders::LayerItem> out;
  out.reserve(items.size());
  for (const LayerItem& item : items) {
    shaders::LayerItem entry{};
    entry.brick = glm::ivec4(item.brick, item.view_count);
    for (int i = 0; i < item.view_count; ++i)
      entry.views[i / 4][i % 4] = item.views[std::size_t(i)];
    out.push_back(entry);
  }
  return gpu::Buffer::of(out);
}

}  // namespace

std::vector<Band> make_bands(int across, int rows) {
  const std::size_t row_bytes = std::size_t(across) * kDecidedEntries * 16;
  const int most = int(gpu::batch_size(row_bytes, std::size_t(rows)));
  const shaders::Column fresh{{-1, -1, 0, 0}, {0, 0, 0, 0}};
  std::vector<Band> bands;
  for (int first = 0; first < rows; first += most) {
    const int count = std::min(most, rows - first);
    const std::size_t columns = std::size_t(across) * std::size_t(count) * 64;
    bands.push_back({first, count, gpu::Buffer::of(std::vector<shaders::Column>(columns, fresh))});
  }
  return bands;
}

BandWork::BandWork(const Band& of, std::span<const LayerItem> items)
    : band(of),
      item_buffer(to_device(items)),
      scores(items.size() * 64 * 16),
      selected(items.size()),
      occluders(items.size() * 128),
      decided(items.size() * kDecidedEntries) {
  for (const LayerItem& item : items) bricks.push_back(item.brick);
}

}  // namespace photohull::carving
