// How light falls on a printed sheet.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace photohull {

/// Texel by texel, row-major from the page's top left.
struct SheetLight {
  int width = 0, height = 0;
  double texels_per_mm = 0;
  glm::dvec2 lower_left{0.0};  ///< the page's corner in the sheet's frame, mm
  /// Square roots of the linear light that bare paper sends, as if all photographs were exposed
  /// alike.
  std::vector<glm::vec3> paper;
  std::vector<std::uint8_t> agreed;  ///< 255 where photographs agree on it; 0: as it is around
  /// Shadows stay where they are from photograph to photograph.
  bool steady = false;

  struct Texel {
    glm::vec3 paper{0.0f};
    bool agreed = false;  ///< of all texels around the place
  };

  bool empty() const { return paper.empty(); }
  /// At a place of the sheet's frame, bilinear; the nearest texel's beside the page.
  Texel at(const glm::dvec2& place) const;
};

}  // namespace photohull
