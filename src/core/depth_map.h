// What a camera sees first, on the host.
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace photohull {

struct DepthMap {
  glm::ivec2 size{0};          ///< texels
  float texels_per_pixel = 1;  ///< at most 1
  std::vector<float> depths;   ///< row-major, in the maker's unit; +infinity where nothing is

  /// At a place on the image (pixels), or at the texel next to it.
  float at(const glm::dvec2& pixel) const {
    const int x = std::clamp(int((pixel.x + 0.5) * texels_per_pixel), 0, size.x - 1);
    const int y = std::clamp(int((pixel.y + 0.5) * texels_per_pixel), 0, size.y - 1);
    return depths[std::size_t(y) * std::size_t(size.x) + std::size_t(x)];
  }
};

}  // namespace photohull
