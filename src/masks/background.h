// Masks for photographs that come without: what does the background look like, over all views?
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"

namespace photohull {

/// How far each colour is from those of the background, and from where on it is the object's.
struct BackgroundModel {
  static constexpr int kCells = 64;  ///< along each axis of the sRGB cube

  /// Distance to the nearest background colour in 8-bit sRGB levels, clamped to 255; index
  /// (r * 64 + g) * 64 + b with the 6 upper bits of each channel.
  std::vector<std::uint8_t> distance;
  int weak = 0;           ///< levels; near strong pixels, the object reaches down to here
  int strong = 0;         ///< levels; from here on a pixel is the object's beyond doubt
  double doubt = 0;       ///< [0, 1]: share of the object's pixels between weak and strong
  double separation = 0;  ///< [0, 1]: how well object and background part

  /// Below this separation the masks cannot be trusted.
  static constexpr double kLeastSeparation = 0.4;
  bool usable() const { return separation >= kLeastSeparation; }
};

/// Takes the pixels along the frame of all images for background, unless their colour is much more
/// common elsewhere (objects cut by the frame). The images may differ in size; each one must have
/// pixels.
BackgroundModel estimate_background(const std::vector<const ColourImage*>& images);

/// The object in one of these images, rather too large than too small: notches, slits and holes
/// that shadows may have caused are closed, the more of them the more doubtful pixels the model
/// saw. Coverage is soft along the contour. Costs about 4 ms for 640 x 480 pixels.
Mask mask_from_background(const BackgroundModel& model, const ColourImage& image);

}  // namespace photohull
