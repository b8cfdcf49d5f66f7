// Sparse points of whatever the photographs show, under the given cameras.
#pragma once

#include <span>
#include <vector>

#include "core/prepared_view.h"
#include "core/progress.h"

namespace photohull {

/// A point of some surface, the object's or its surroundings'.
struct ScenePoint {
  glm::dvec3 position{0.0};  ///< world
  std::vector<int> views;    ///< that show it, ascending; two or more
};

/// Features of neighbouring views, matched near the epipolar lines of the given cameras and aligned
/// (find_tracks), triangulated. A point counts where it projects within two pixels of its features
/// (root mean square) and its rays differ by two degrees at least: a feature that is half a pixel
/// off then moves it by less than a tenth of its distance. Neighbours are those nearest by position
/// that look the same way within 60 degrees, with gaps that grow, so that views of a video find
/// partners at a distance, too. Meant for reduced photographs: the time grows with their pixels.
/// Same result whatever the number of threads. Throws Cancelled.
std::vector<ScenePoint> find_scene_points(std::span<const PreparedView> views, Progress& progress);

}  // namespace photohull
