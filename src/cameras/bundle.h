// The Ceres problem behind refine_cameras. Internal to cameras.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "cameras/frontier.h"
#include "cameras/refine_cameras.h"
#include "cameras/triangulate.h"

namespace photohull {

struct BundleInput {
  std::span<const Track> tracks;
  std::span<const FrontierPair> tangents;
  std::vector<glm::dvec3> points;  ///< where each track starts
  double track_sigma = 1;          ///< pixels: spread of the tracks' residuals
  double tangent_sigma = 1;        ///< pixels: that of the tangents'
  double prior_sigma = 10;         ///< pixels: how wrong the given cameras may well be
  SharedIntrinsics intrinsics = SharedIntrinsics::kNone;
  bool hold_poses = false;
  std::vector<int> held;   ///< views whose poses stay, beside that
  glm::dvec3 middle{0.0};  ///< of the object; cameras turn about it
};

/// Cameras that minimise the residuals from `start`, held to `prior` by weak springs.
/// Residuals of three times the spread and more lose their weight (Cauchy). Sets `shared` to the
/// focal factor and the principal point's offset, relative to `start`.
std::vector<Camera> adjust_bundle(const BundleInput& input, std::span<const Camera> start,
                                  std::span<const Camera> prior, std::array<double, 3>& shared);

}  // namespace photohull
