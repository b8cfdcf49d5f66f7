// Errors that all views have alike, which silhouettes show although no view stands out.
#pragma once

#include <span>

#include "cameras/frontier.h"
#include "core/camera.h"

namespace photohull::assess {

/// How principal points and focal lengths of all views would have to change for the silhouettes'
/// tangents to agree best. Masks that are all shifted ask for the same as principal points do.
struct CommonError {
  glm::dvec2 shift{0.0};         ///< pixels
  double focal_factor = 1;       ///< on focal lengths
  double shift_sigma = 0;        ///< pixels, standard deviation, of the less certain of x and y
  double focal_sigma = 0;        ///< standard deviation of focal_factor
  double before = 0, after = 0;  ///< pixels, what tangents disagree by: median
  int tangents = 0;              ///< 0: nothing is known, and all else as it stands here

  /// Does the change mend most of what tangents disagree by?
  bool mends() const;
  /// Does it mend, and is the shift, or the factor, certain?
  bool shift_counts() const;
  bool focal_counts() const;
};

/// Robust least squares over the tangents of all pairs of views (frontier_pairs), which are found
/// anew after every step. `outlines`: one for each camera.
CommonError find_common_error(std::span<const Camera> cameras, std::span<const Outline> outlines);

}  // namespace photohull::assess
