// The colour cube in cells, as the background model and its masks index it.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "masks/background.h"

namespace photohull {

inline std::size_t colour_cell(int r, int g, int b) {
  constexpr std::size_t n = BackgroundModel::kCells;
  return (std::size_t(r >> 2) * n + std::size_t(g >> 2)) * n + std::size_t(b >> 2);
}

/// 8-bit sRGB value of each linear half float, by its bits.
const std::vector<std::uint8_t>& srgb_of_half();

/// Calls visit(x, cell) for every `step`-th pixel of row y with x in [x0, x1).
template <typename Visit>
void for_each_cell(const ColourImage& image, int x0, int x1, int y, int step, const Visit& visit) {
  const std::uint8_t* row = &image.bytes[std::size_t(y) * image.width * image.bytes_per_pixel()];
  if (image.encoding == ColourImage::Encoding::kSrgb8) {
    for (int x = x0; x < x1; x += step) {
      const std::uint8_t* p = row + std::size_t(x) * 4;
      visit(x, colour_cell(p[0], p[1], p[2]));
    }
    return;
  }
  const std::vector<std::uint8_t>& srgb = srgb_of_half();
  for (int x = x0; x < x1; x += step) {
    std::uint16_t half[3];
    std::memcpy(half, row + std::size_t(x) * 8, sizeof half);
    visit(x, colour_cell(srgb[half[0]], srgb[half[1]], srgb[half[2]]));
  }
}

}  // namespace photohull
