// Thin parts that a mask has lost, looked for in the photograph.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/image.h"
#include "core/prepared_view.h"
#include "core/silhouette.h"

namespace photohull {

struct PhotoLineOptions {
  double noise_sigma = 0;  ///< of the photograph (photo/noise.h)
  /// Pixels, up to kWidest: what is wider than this the mask would still hold some of.
  double widest = 3;
  /// Of wider ones the background is beyond what is looked at, 4.5 pixels to either side.
  static constexpr double kWidest = 4;
};

/// Lines of the photograph outside the mask: ridges of its colours, of any sign [Steger98], to a
/// fraction of a pixel, with the same background on both sides. About one point a pixel along each.
/// A line's width is the light that it adds to or takes from its background, over the difference of
/// the object's colours to it. Textures of a background have such lines, too: they say where the
/// object may be, and views must confirm each other (carving/confirm_lines.h). `distance` is that
/// of the view's mask; the view must have one.
std::vector<LinePoint> find_photo_lines(const PreparedView& view,
                                        const SilhouetteDistance& distance,
                                        const PhotoLineOptions& options);

/// Puts lines back into the view's mask. Where the background around them is plain, their coverage
/// is what the photograph says: the light of each pixel beside the lines, and beside `places`, lies
/// between the background's and the object's. Elsewhere, and where that finds less than half of a
/// line, it is that of a band as wide as the line. `places`: pixels where other views show that
/// there are lines. Lowers nothing.
void restore_lines(const std::vector<LinePoint>& lines, std::span<const glm::dvec2> places,
                   const SilhouetteDistance& distance, PreparedView& view);

/// Raises the coverage to that of bands as wide as the lines. Lowers nothing.
void draw_lines(const std::vector<LinePoint>& lines, Mask& mask);

}  // namespace photohull
