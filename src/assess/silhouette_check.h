// Does a reconstructed surface fill the silhouettes, and nothing else?
#pragma once

#include <span>
#include <vector>

#include "core/box.h"
#include "core/camera.h"
#include "core/image.h"
#include "core/silhouette.h"
#include "raycast/ray_scene.h"

namespace photohull::assess {

/// Shares of areas, [0, 1].
struct SilhouetteFit {
  double missed = 0;        ///< of the foreground, that the surface does not cover
  double missed_width = 0;  ///< pixels: how wide the parts are that it does not, in the mean
  double excess = 0;        ///< of the surface's picture, that lies on background
  double beyond_box = 0;    ///< of the foreground, whose rays do not meet the box
  int foreground = 0, covered = 0;  ///< places looked at; 0 where nothing is known
};

/// What is known of a view's silhouette; nullptr: nothing.
struct CheckedSilhouette {
  const SilhouetteDistance* given = nullptr;      ///< of the mask: what the surface must cover
  const SilhouetteDistance* used = nullptr;       ///< with room for lines: what it must not exceed
  const std::vector<LinePoint>* lines = nullptr;  ///< of the mask: covered as well
  /// Foreground of little more than half the coverage is in doubt and counts little; nullptr: all
  /// of it counts.
  const Mask* mask = nullptr;
};

/// Does the surface lie within `tolerance` (pixels) of the line's point in the picture? Looked for
/// across the line, and along it, for the direction of a short dash is not known.
bool covers_line(const RayScene& rays, const Camera& camera, const LinePoint& point,
                 double tolerance);

/// One for each view, by rays through lattices of some thousand pixels, of the foreground for what
/// is missed and of the whole picture for the excess, and through the lines. Pixels within
/// `tolerance` of the silhouette's contour (pixels) do not count, but for the middles of parts that
/// are narrower than twice that, which count as lines do. Nor do those whose ray does not meet the
/// box. A line is covered where the surface is within `tolerance` of its middle.
std::vector<SilhouetteFit> check_silhouettes(const RayScene& rays, const Box& box,
                                             std::span<const Camera> cameras,
                                             std::span<const CheckedSilhouette> silhouettes,
                                             double tolerance);

}  // namespace photohull::assess
