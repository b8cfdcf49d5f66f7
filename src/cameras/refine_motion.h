// The motion between two worlds in which the same object was photographed, by features that both
// show. Internal to cameras.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "cameras/feature_tracks.h"
#include "cameras/rigid_motion.h"

namespace photohull {

struct MotionProblem {
  std::span<const Camera> cameras;  ///< each in its own world
  std::size_t first_moved = 0;      ///< cameras from here on are of the world that is moved
  std::span<const Track> tracks;    ///< over all of them
  RigidMotion start;                ///< from the moved world to the other one
  glm::dvec3 middle{0.0};           ///< of the object, in the other one
};

struct RefinedMotion {
  RigidMotion motion;
  /// Of the turn about the object's middle (radians, about the axes of the world that stays) and of
  /// the middle's place (world units).
  std::array<std::array<double, 6>, 6> covariance{};
  bool determined = false;         ///< no motion is open, else no covariance
  std::vector<glm::dvec3> points;  ///< of the tracks that fit, in the world that stays
  /// Pixels, median: how far from where photographs of one world show a point it lies by those of
  /// the other world alone. NaN where no track is seen twice in one of them.
  double seam = 0;
};

/// Motion and points that minimise the distances between the points' projections and the tracks'
/// pixels, by Ceres with a robust loss [Triggs99]; tracks that do not fit are left out and the rest
/// fitted again. Covariance by the jackknife over photographs (motion_jackknife.h): errors of their
/// cameras count, as far as these are each photograph's own. Nothing where fewer than eight tracks
/// seen in both worlds fit.
std::optional<RefinedMotion> refine_motion(const MotionProblem& problem);

/// Standard deviation of where the motion puts a point of the world that stays, world units: the
/// root of the mean over three axes. Infinite where it is not determined.
double deviation_at(const RefinedMotion& refined, const glm::dvec3& middle,
                    const glm::dvec3& point);

}  // namespace photohull
