// Private to module texture: rectangles side by side on pages.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace photohull::texture {

struct Packed {
  glm::ivec2 page{0};  ///< size of every page; edges are powers of two
  std::uint32_t pages = 0;
  std::vector<glm::ivec2> place;  ///< of each rectangle's top-left corner
  std::vector<std::uint32_t> on;  ///< which page
};

/// Places rectangles by the skyline's lowest place, high ones first. One page as small as holds
/// all, or as many of `most_edge` squared (a power of two) as are needed. No rectangle may be
/// larger than that.
Packed pack(std::span<const glm::ivec2> sizes, int most_edge);

}  // namespace photohull::texture
