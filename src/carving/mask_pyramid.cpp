#include "carving/mask_pyramid.h"

#include <algorithm>
#include <bit>

#include "core/error.h"

namespace photohull::carving {
namespace {

constexpr int kBlock = MaskPyramid::kBlock;

std::vector<std::uint8_t> reduce_mask(const Mask& mask, int width, int height) {
  std::vector<std::uint8_t> cells(std::size_t(width) * height * 2);
  for (std::size_t i = 0; i < cells.size(); i += 2) cells[i] = 255;
  for (int y = 0; y < mask.height; ++y) {
    const std::uint8_t* row = &mask.coverage[std::size_t(y) * mask.width];
    std::uint8_t* out = &cells[std::size_t(y / kBlock) * width * 2];
    for (int x = 0; x < mask.width; ++x) {
      std::uint8_t* cell = out + (x / kBlock) * 2;
      cell[0] = std::min(cell[0], row[x]);
      cell[1] = std::max(cell[1], row[x]);
    }
  }
  return cells;
}

std::vector<std::uint8_t> reduce_cells(const std::vector<std::uint8_t>& fine, int width,
                                       int height) {
  const int w = std::max(width / 2, 1), h = std::max(height / 2, 1);
  std::vector<std::uint8_t> cells(std::size_t(w) * h * 2);
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      std::uint8_t low = 255, high = 0;
      for (int dy = 0; dy < 2; ++dy)
        for (int dx = 0; dx < 2; ++dx) {
          const int fx = std::min(2 * x + dx, width - 1), fy = std::min(2 * y + dy, height - 1);
          const std::uint8_t* cell = &fine[(std::size_t(fy) * width + fx) * 2];
          low = std::min(low, cell[0]);
          high = std::max(high, cell[1]);
        }
      cells[(std::size_t(y) * w + x) * 2] = low;
      cells[(std::size_t(y) * w + x) * 2 + 1] = high;
    }
  return cells;
}

}  // namespace

MaskPyramid build_mask_pyramid(const Mask& mask, int array_width, int array_height) {
  PHOTOHULL_CHECK(mask.width <= array_width && mask.height <= array_height);
  const auto cells = [](int pixels) {
    return int(std::bit_ceil(unsigned((pixels + kBlock - 1) / kBlock)));
  };
  MaskPyramid pyramid;
  pyramid.width = cells(array_width);
  pyramid.height = cells(array_height);
  int width = pyramid.width, height = pyramid.height;
  pyramid.levels.push_back(reduce_mask(mask, width, height));
  while (width > 1 || height > 1) {
    pyramid.levels.push_back(reduce_cells(pyramid.levels.back(), width, height));
    width = std::max(width / 2, 1);
    height = std::max(height / 2, 1);
  }
  return pyramid;
}

}  // namespace photohull::carving
