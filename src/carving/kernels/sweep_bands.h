// What a plane sweep works on, in parts that fit into the device's storage blocks (internal to
// carving).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "carving/layer_item.h"
#include "core/grid.h"
#include "gpu/buffer.h"

namespace photohull::carving {

/// A list with a header of four words, the first being its length.
struct DeviceList {
  gpu::Buffer buffer;
  explicit DeviceList(std::size_t capacity) : buffer(16 + capacity * 16) { clear(); }
  void clear() {
    const std::uint32_t zeros[4] = {};
    buffer.write(0, 16, zeros);
  }
  std::size_t count() const { return buffer.download<std::uint32_t>(1)[0]; }
};

/// Some rows of bricks of the plane across a sweep.
struct Band {
  int first_row, rows;  ///< bricks
  gpu::Buffer columns;  ///< of voxels, row by row

  bool has(int row) const { return row >= first_row && row < first_row + rows; }
};

/// Bands of a plane of `across` x `rows` bricks, as few as storage blocks allow; no path is open.
std::vector<Band> make_bands(int across, int rows);

/// A band's part of a slab of bricks: its items, and what the kernels find in them.
struct BandWork {
  const Band& band;
  std::vector<glm::ivec3> bricks;  ///< of the items
  gpu::Buffer item_buffer, scores;
  DeviceList selected, occluders, decided;

  BandWork(const Band& of, std::span<const LayerItem> items);
};

}  // namespace photohull::carving
