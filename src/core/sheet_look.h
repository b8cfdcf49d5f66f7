// What a photograph would show of a printed sheet if nothing stood on it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace photohull {

/// Pixel by pixel, row-major from the top left.
struct SheetLook {
  int width = 0, height = 0;
  /// Share of the paper's light that the pixel sends: 0 ink, 1 bare paper, averaged over its area;
  /// negative where it shows something else than the page, in part at least.
  std::vector<float> light;
  int mixed = 2;  ///< pixels beside those that show the page which may show a part of it
  std::vector<std::uint8_t> possible;  ///< 255 where the object may appear: its box does
  /// 255 where all photographs' masks together have room for the object; empty: not known.
  std::vector<std::uint8_t> hull;
  /// Square roots of the light that bare paper sends to the pixel, exposed as in no photograph in
  /// particular (SheetLight::paper); empty: not known.
  std::vector<glm::vec3> paper;
  std::vector<std::uint8_t> agreed;  ///< 255 where photographs agree on that; as large as `paper`
  bool steady = false;  ///< shadows on the sheet are the same in all of them (SheetLight::steady)
};

}  // namespace photohull
