// Features matched between views whose cameras may be all wrong. Internal to cameras.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/prepared_view.h"
#include "core/progress.h"

namespace photohull {

/// Pixels of two views that show the same points of the object.
struct PairMatches {
  int view_a = 0, view_b = 0;
  std::vector<std::pair<glm::dvec2, glm::dvec2>> pixels;  ///< in a and in b
};

/// SIFT features [Lowe04] that are each other's nearest, as far as some fundamental matrix has them
/// on its epipolar lines [Hartley04, chapter 11]: the views' poses are not used. Pairs where that
/// leaves fewer than 16 matches, or fewer than half of them, do not appear. Throws Cancelled.
std::vector<PairMatches> match_without_cameras(std::span<const PreparedView> views,
                                               std::span<const std::pair<int, int>> pairs,
                                               Progress& progress);

}  // namespace photohull
