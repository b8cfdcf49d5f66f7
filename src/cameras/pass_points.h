// Points of a surface that can be found again in other photographs of it. Internal to cameras; only
// for files that know OpenCV.
#pragma once

#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "cameras/rigid_motion.h"
#include "core/box.h"
#include "core/prepared_view.h"
#include "core/progress.h"

namespace photohull {

struct DescribedPoints {
  std::vector<glm::dvec3> places;  ///< world
  std::vector<double> tolerances;  ///< of each: world units that it may well be off
  cv::Mat descriptors;             ///< CV_32F; rows of length 1, one or more for each point
  std::vector<int> owners;         ///< of each row: the point

  /// Adds another pass's points, moved.
  void add(const DescribedPoints& others, const RigidMotion& motion);
};

/// Tracks of the object (find_described_tracks) within the box, triangulated; those whose rays
/// differ by two degrees at least. Throws Cancelled.
DescribedPoints find_described_points(std::span<const PreparedView> views, const Box& box,
                                      Progress& progress);

/// Points that are each other's nearest by descriptors, and clearly nearer than any at another
/// place [Lowe04].
std::vector<PointPair> match_points(const DescribedPoints& from, const DescribedPoints& to);

}  // namespace photohull
