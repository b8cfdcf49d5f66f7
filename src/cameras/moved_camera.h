// A camera that an adjustment turns and moves, and its residuals with their derivatives. Internal
// to cameras.
#pragma once

#include <array>

#include "cameras/frontier.h"
#include "core/camera.h"

namespace photohull {

/// What all cameras share in an adjustment: the focal factor's logarithm in units of kFocalUnit,
/// and the principal point's offset in pixels.
using SharedUnknowns = std::array<double, 3>;
inline constexpr double kFocalUnit = 1e-3;

/// A given camera's motion: a turn about the object's middle and a move, both in the camera's own
/// frame. The six unknowns are in units that move the object in the image by about a pixel each.
struct Motion {
  Camera camera;           ///< as given
  glm::dvec3 middle{0.0};  ///< of the object, in the camera's frame
  double turn = 1;         ///< radians a unit
  double move = 1;         ///< world units a unit

  /// `world`: the object's middle.
  Motion(const Camera& given, const glm::dvec3& world);
  /// The unknowns that bring the given camera to the pose of `other`.
  std::array<double, 6> unknowns_to(const Pose& other) const;
};

/// A motion carried out, with what derivatives need.
struct MovedCamera {
  Intrinsics intrinsics;
  Pose pose;
  glm::dvec3 center{0.0};    ///< world
  glm::dvec3 pivot{0.0};     ///< what the camera turns about, in its frame
  glm::dmat3 turning{1.0};   ///< from a change of the turn's unknowns to a rotation vector
  glm::dmat3 world_turn{1};  ///< the same with the rotation vector in world axes
  double move = 1;           ///< world units a unit

  MovedCamera() = default;
  MovedCamera(const Motion& motion, const double* unknowns);
};

/// Derivatives by a camera's six unknowns, one row a residual.
using ByPose = std::array<std::array<double, 6>, 2>;
using By3 = std::array<std::array<double, 3>, 2>;

struct TrackDerivatives {
  ByPose by_pose;
  By3 by_point, by_shared;
};

/// From an observed pixel to the projection of a point, in pixels. False where the point is not in
/// front of the camera. `derivatives` may be null.
bool track_residual(const MovedCamera& camera, const SharedUnknowns& shared,
                    const glm::dvec3& point, const glm::dvec2& pixel, glm::dvec2& residual,
                    TrackDerivatives* derivatives);

struct TangentDerivatives {
  ByPose by_pose_a, by_pose_b;
  By3 by_shared;
};

/// Signed distances of the pixels of a pair from each other's epipolar line, in pixels, to first
/// order. `derivatives` may be null.
glm::dvec2 tangent_residual(const MovedCamera& a, const MovedCamera& b,
                            const SharedUnknowns& shared, const FrontierPair& pair,
                            TangentDerivatives* derivatives);

}  // namespace photohull
