// How light falls on a sheet, shadows included, from photographs in which an object hides different
// parts of it.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>

#include "core/image.h"
#include "core/sheet_light.h"

namespace photohull {

/// Photographs of one sheet, read when they are asked for, several at a time. Places and lengths
/// are of the sheet's frame, millimetres.
struct SheetPhotographs {
  std::size_t count = 0;
  std::function<ColourImage(std::size_t)> image;
  /// Where a place of the sheet is on the image; nothing where it is behind the camera.
  std::function<std::optional<glm::dvec2>(std::size_t, const glm::dvec2& place)> pixel;
  /// May the object hide a place, which is at that pixel of an image of that size?
  std::function<bool(std::size_t, const glm::dvec2& place, const glm::dvec2& pixel,
                     const glm::ivec2& size)>
      possible;
  std::function<glm::dvec3(std::size_t)> eye;
  std::function<float(const glm::dvec2& place)> print;  ///< 0 ink, 1 bare paper
  glm::dvec2 lower_left{0.0}, page{0.0};
  /// Called with the number of photographs that were read, never twice at once.
  std::function<void(std::size_t)> read = [](std::size_t) {};
  double pixels = 2e6;  ///< of each, about
  double finest = 0.3;  ///< between lattice points
  double held = 256e6;  ///< bytes of all photographs' samples together
};

/// Lattice by lattice point of the page: the light that at least three photographs agree on in
/// which the object cannot hide it; else the one that the largest group agrees on, if it has four
/// photographs and a third of those that show the place, from directions 60 degrees apart, no other
/// group is half as large, and it has the paper's hue: the object looks different from different
/// sides, and a shadow that stands still does not. Between such points it is continued smoothly.
/// Exposures may differ, and fall off towards the images' corners. Light is steady where no more
/// than two percent of what is seen where the object cannot be are darker than that. Empty where
/// less than a hundred places are seen beside the object.
SheetLight find_sheet_light(const SheetPhotographs& photographs);

}  // namespace photohull
