// A sheet as it is printed, and as a picture.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sheet/sheet.h"

namespace photohull {

/// An SVG document of the page's size in millimetres: black on white, the bar with its length, and
/// a thin grey outline of the free space; or of the pieces of a strip, with the tabs to be glued.
std::string sheet_svg(const Sheet& sheet);

/// The same as a PDF page, by librsvg and cairo. The same sheet gives the same bytes on a machine.
/// Throws Error when they fail.
std::string sheet_pdf(const Sheet& sheet);

/// How light the printed page is, texel by texel.
struct SheetPicture {
  int width = 0, height = 0;
  double texels_per_mm = 0;
  glm::dvec2 lower_left{0.0};       ///< the page's corner in the sheet's frame, mm
  std::vector<std::uint8_t> light;  ///< row-major from the top left; 0 ink, 255 bare paper

  /// At a place of the sheet's frame, bilinear between texels' middles: from 0, ink, to 1, bare
  /// paper; negative beside the page.
  float at(const glm::dvec2& place) const;
};

/// Drawn by librsvg; a texel's value is the share of its area that is bare paper.
SheetPicture sheet_picture(const Sheet& sheet, double texels_per_mm);

}  // namespace photohull
