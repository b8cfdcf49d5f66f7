// The background of a camera that stands still, from photographs in which something turns before
// it.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "core/image.h"
#include "core/sheet_look.h"

namespace photohull {

/// Photographs of one size by one camera, read when they are asked for, several at a time.
struct StillPhotographs {
  std::size_t count = 0;
  int width = 0, height = 0;  ///< pixels
  std::function<ColourImage(std::size_t)> image;
  /// What the photograph would show of the sheet alone, in a picture of that many pixels.
  std::function<SheetLook(std::size_t, int width, int height)> look;
  /// The photograph's mask, of any size; empty: not known.
  std::function<Mask(std::size_t)> mask = [](std::size_t) { return Mask(); };
  double held = 60e6;  ///< pixels of all photographs together that memory holds at once
  /// Share that is done; never called twice at once.
  std::function<void(double)> progress = [](double) {};
};

enum class Stillness {
  kStill,
  kChanges,  ///< the camera moved, or what is behind the sheet did
  kPlain     ///< too few edges are seen behind sheet and box to tell
};

/// The light behind the sheet and the object, pixel by pixel, row-major.
struct StillBackground {
  enum Level : std::uint8_t {
    kUnknown,   ///< most photographs show no same light there
    kDoubtful,  ///< all do, but the object may be in the way in all of them
    kSure
  };

  Stillness stillness = Stillness::kPlain;
  double edges_kept = 0;  ///< [0, 1]: edges of a photograph that another one has in the same place
  /// Where it is still and was asked for; else empty.
  int width = 0, height = 0;
  std::vector<std::uint16_t> light;  ///< square roots of linear red, green and blue; 65535: 1
  std::vector<std::uint8_t>
      deviation;  ///< of the photographs, thousandths of the root's full scale
  std::vector<std::uint8_t> level;

  bool empty() const { return light.empty(); }
};

/// Do the photographs show the same behind sheet and box? Edges there are compared between pairs of
/// photographs, each with the one half the series later. With `model`, where they do: the median of
/// each pixel over the photographs in which it shows no page, by which the others are told, and
/// their mean [Piccardi04]. What a mask has for the object does not count. Photographs in which the
/// object's box does not cover the pixel go first; where there are fewer than four, the largest
/// group of four or more tells that show the same around the pixel, if no other group is half as
/// large or has three. The medians are made of smaller pictures where the photographs have more
/// than `held` pixels together, so that memory does not grow with their number: 7 bytes for each
/// pixel held, and 40 for each of one photograph. Exposures may differ. Needs at least two
/// photographs; throws what reading them does.
StillBackground find_still_background(const StillPhotographs& photographs, bool model);

}  // namespace photohull
