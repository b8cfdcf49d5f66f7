// Does a reconstructed surface fill the silhouettes, and nothing else?
#pragma once

#include <span>
#include <vector>

#include "core/box.h"
#include "core/camera.h"
#include "core/silhouette.h"
#include "raycast/ray_scene.h"

namespace photohull::assess {

/// Shares of the pixels looked at, [0, 1].
struct SilhouetteFit {
  double missed = 0;                ///< of the silhouette's, that the surface does not cover
  double excess = 0;                ///< of the surface's, that lie on background
  int foreground = 0, covered = 0;  ///< pixels looked at; 0 where nothing is known
};

/// One for each view, by rays through a lattice of some thousand pixels. Pixels within `tolerance`
/// of the silhouette's contour (pixels) do not count, nor do those whose ray does not meet the box.
/// `silhouettes` holds a distance or nullptr for each view.
std::vector<SilhouetteFit> check_silhouettes(const RayScene& rays, const Box& box,
                                             std::span<const Camera> cameras,
                                             std::span<const SilhouetteDistance* const> silhouettes,
                                             double tolerance);

}  // namespace photohull::assess
