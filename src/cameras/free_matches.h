// Features matched between views whose cameras may be all wrong. Internal to cameras.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/prepared_view.h"
#include "core/progress.h"

namespace photohull {

struct Features;

/// Places of the same point in two photographs.
using PixelPairs = std::vector<std::pair<glm::dvec2, glm::dvec2>>;

/// Pixels of two views that show the same points of the object.
struct PairMatches {
  int view_a = 0, view_b = 0;
  PixelPairs pixels;  ///< in a and in b
};

/// Features that are each other's nearest, as far as some fundamental matrix has them within
/// `tolerance` pixels of its epipolar lines [Hartley04, chapter 11]: no camera is used. Empty where
/// that leaves fewer than 16, or fewer than half of them. What moved by less than `least_motion`
/// pixels does not count.
PixelPairs match_freely(const Features& a, const Features& b, double tolerance,
                        double least_motion = 0);

/// SIFT features [Lowe04] of views, matched by match_freely: the views' poses are not used. Pairs
/// without matches do not appear. Throws Cancelled.
std::vector<PairMatches> match_without_cameras(std::span<const PreparedView> views,
                                               std::span<const std::pair<int, int>> pairs,
                                               Progress& progress);

}  // namespace photohull
