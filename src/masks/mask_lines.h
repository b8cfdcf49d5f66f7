// Parts of a silhouette that are narrower than about two pixels, and the room that they need.
#pragma once

#include <cstdint>
#include <vector>

#include "core/image.h"
#include "core/silhouette.h"

namespace photohull {

/// Widest part that counts as a line, pixels. What is wider shows its two outlines.
inline constexpr double kWidestLine = 2.5;

/// The lines of a mask: ridges of its coverage [Steger98], about one point a pixel along each, row
/// by row. Coverage is a share of the pixel's area, so that its integral across a line is the
/// line's width, however few percent a pixel holds of it. Lines narrower than a tenth of a pixel
/// are not told from the rounding and the ringing of masks. `mask` must not be empty.
std::vector<LinePoint> find_lines(const Mask& mask);

/// Coverage from which on a mask that was made is sure of its foreground, of 255: its coverage is
/// the chance, and this is the middle between no knowledge, one half, and certainty.
inline constexpr std::uint8_t kSureForeground = 192;

/// Those of a made mask's lines that are sure foreground: most ridges of likelihoods are fringes
/// of the background.
std::vector<LinePoint> sure_lines(const Mask& mask, std::vector<LinePoint> lines);

/// Pixels by which a line of this width must be widened on either side before its distance is
/// sampled once a pixel: half a pixel, by which the bilinear interpolation of the distance to a
/// line is too large at most; nothing from kWidestLine on.
double line_slack(double width);

/// Raises the coverage around the lines as if each were wider by its slack on either side: bands
/// that leave no gap between pixels, and that silhouette_distance traces. Lowers nothing.
void widen_lines(const std::vector<LinePoint>& lines, Mask& mask);

}  // namespace photohull
