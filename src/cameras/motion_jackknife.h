// How far a motion found from features may be off, when photographs' cameras are, too. Internal to
// cameras.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace photohull {

/// A pixel of a track in the linearised problem, where the fit ended: weighted residuals, and how
/// they change with the motion and with the track's point.
struct LinearPixel {
  int view = 0;
  bool moved = false;  ///< of the world that is moved
  std::array<double, 2> residual{};
  std::array<std::array<double, 6>, 2> by_motion{};
  std::array<std::array<double, 3>, 2> by_point{};
};

using MotionCovariance = std::array<std::array<double, 6>, 6>;

/// Covariance of the motion by the jackknife over photographs [Efron82]: each is left out in turn,
/// and the linearised problem solved again, points with it. What a photograph's pixels have in
/// common, as by its camera's error, so counts once and not as often as it has pixels. Tracks that
/// a world no longer shows then are left out, too. Nothing where one photograph alone decides.
std::optional<MotionCovariance> jackknife(std::span<const std::vector<LinearPixel>> tracks);

}  // namespace photohull
