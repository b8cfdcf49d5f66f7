#include "carving/sweep_bands.h"

#include <algorithm>

#include "gpu/limits.h"

namespace photohull::carving {
namespace {

// Of a brick in its list of decisions, which is the longest that the sweep has: two for each.
constexpr std::size_t kDecidedEntries = kBrickVoxels * 2;
static_assert(kDecidedEntries * 16 == kBrickVoxels * sizeof(shaders::Decision));
static_assert(kDecidedEntries * 16 >= 64 * sizeof(shaders::Column));

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

BandWork::BandWork(const Band& of, std::vector<shaders::LayerItem> list)
    : band(of),
      items(std::move(list)),
      item_buffer(gpu::Buffer::of(items)),
      scores(items.size() * 64 * 16),
      selected(items.size()),
      occluders(items.size() * 128),
      decided(items.size() * kDecidedEntries) {}

}  // namespace photohull::carving
