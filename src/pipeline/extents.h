// Where a scene's cameras and points are, and a box for those who have none.
#pragma once

#include <optional>
#include <vector>

#include "core/box.h"
#include "core/scene.h"

namespace photohull::pipeline {

/// World units, axis by axis.
struct Extents {
  /// What is left of the points without the same share of them on each side.
  struct Share {
    double low = 0, high = 1;  ///< quantiles
    Box box;
  };

  Box cameras;                ///< of the optical centres
  std::vector<Share> points;  ///< the widest first; empty without points
};

Extents measure_extents(const Scene& scene);

/// A box that no camera stands in, from the cameras and the scene file's points alone: as find_box
/// has it where there are 100 points, else a cube that the cameras have on their images about where
/// they look. Nothing where they do not look at one place.
std::optional<Box> suggest_box(const Scene& scene);

}  // namespace photohull::pipeline
