// Lenses of cameras that were found with their principal points held in the middle.
#pragma once

#include <vector>

#include "core/progress.h"
#include "core/scene.h"

namespace photohull {

/// A lens that some of the views share: a focal length, a principal point and one radial term.
struct AdjustedLens {
  int views = 0;
  Intrinsics intrinsics;
  Distortion distortion;
  double focal_sigma = 0;           ///< pixels, standard deviation
  glm::dvec2 principal_sigma{0.0};  ///< pixels, standard deviations
};

/// One bundle adjustment [Triggs99] of the scene's views and tracks, in which principal points are
/// free. Photographs do not always tell them: a ring at one elevation leaves the row of the
/// principal point open, which a turn of all cameras makes up for. So each has a prior about the
/// middle of the photograph, of the width that lenses and their sensors have: what tracks tell
/// moves, and what they leave open stays. Writes lenses, poses and points (those of the tracks) to
/// the scene; its world stays that of the first view, at a scale of its own. Radial terms beyond
/// the first are not looked at. Standard deviations contain the prior.
///
/// `lens_of_view`: for each view the index of its lens; lenses count from 0 without a gap. Empty,
/// and the scene as it is, where there are no tracks to go by or the adjustment does not succeed.
/// The same for the same input, to the bit. Throws Cancelled.
std::vector<AdjustedLens> adjust_lenses(Scene& scene, const std::vector<std::size_t>& lens_of_view,
                                        Progress& progress);

}  // namespace photohull
