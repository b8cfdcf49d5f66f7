// Is the surface where the photographs have it? Patches matched anew, without the mesh's depth.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "assess/surface_probes.h"
#include "core/prepared_view.h"
#include "core/silhouette.h"

namespace photohull::assess {

/// How one view's matches lie beside the lines where its and the other views' cameras allow them.
struct ViewResidual {
  double pixels = 0;      ///< median distance from the epipolar lines
  int matches = 0;        ///< that are fine enough for this
  double pixel_size = 0;  ///< world units that a pixel covers at the matches, median
};

/// Shares are of the probes, [0, 1].
struct MatchEvidence {
  double seen = 0;      ///< seen by two views or more from angles 5 to 50 degrees apart
  double textured = 0;  ///< of all: seen so, and not plain
  double matched = 0;   ///< of the textured: found again in another view
  /// Of all: textured, and so surrounded by textured probes most of which are not found again, or
  /// far off, that this is no chance.
  double unconfirmed_patches = 0;
  /// Of the matched: how far along its normal the surface is from where two views put it, world
  /// units; the median, and the shares of those beyond `near` and `far`. Matches between views one
  /// of which is too coarse there to tell do not count.
  double offset = 0, beyond_near = 0, beyond_far = 0;
  double residual = 0;    ///< pixels, median distance of all matches from their epipolar lines
  double pixel_size = 0;  ///< world units, median; as a view sees it
  std::vector<ViewResidual> views;
};

struct MatchOptions {
  int radius = 5;                 ///< of the patches, pixels
  double farthest = 6;            ///< pixels from where the surface has the patch
  double least_agreement = 0.55;  ///< normalised cross-correlation
  double noise = 0;               ///< of the images, standard deviation in 8-bit levels
  double near = 0, far = 0;       ///< world units, for the shares
  double coarsest = 0;            ///< world units that a pixel may cover
};

/// Patches around each probe in the view that it faces most are aligned in two others over affine
/// warps, gain and offset [Gruen85], starting from where the surface's tangent plane has them. The
/// shift along the epipolar line tells where the surface is, the one across it how well the cameras
/// agree, where a pixel of both views is below `coarsest` at the probe. Patches that reach over the
/// silhouette (where views have one) are left out. `silhouettes` holds a distance or nullptr for
/// each view.
MatchEvidence match_probes(std::span<const SurfaceProbe> probes,
                           std::span<const PreparedView> views,
                           std::span<const SilhouetteDistance* const> silhouettes,
                           const MatchOptions& options);

}  // namespace photohull::assess
