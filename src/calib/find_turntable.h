// A turntable, told from the cameras of photographs on a printed sheet.
#pragma once

#include <string>
#include <vector>

#include "calib/pose_photographs.h"

namespace photohull {

/// Photographs that one camera took from one place while the sheet turned.
struct TurntableStation {
  int camera = 0;                   ///< index of PoseResult::cameras
  std::vector<std::size_t> photos;  ///< indices of PoseResult::photos, ascending
};

/// How a sheet turned before cameras that stood still. The same motion is that of a camera that
/// goes around the sheet on a circle: only the background tells them apart.
struct TurntableMotion {
  bool found = false;
  std::string reason;                      ///< one sentence: why it was not found
  glm::dvec3 direction{0.0, 0.0, 1.0};     ///< of the axis, unit, up from the sheet
  glm::dvec3 point{0.0};                   ///< where the axis meets the plane z = 0, world units
  std::vector<TurntableStation> stations;  ///< the one with most photographs first
  /// Degrees in [0, 360), by which the sheet had turned about the axis (right-hand rule) since its
  /// station's first photograph; NaN for photographs that belong to no station.
  std::vector<double> angles;
  double rms_degrees = 0;  ///< root mean square over the photographs: rotations about the axis
  double rms_length = 0;   ///< the same, of the axis' place in the camera's frame, world units
};

/// The axis d, p of the sheet's frame that each station's cameras have in one place of their own
/// frames: R_k d = a and R_k p + t_k = q for all photographs k. Stations are found by pairs of
/// photographs [Fischler81]; then d is the eigenvector of the least eigenvalue, and p the solution
/// of a linear problem, both by least squares over all stations, as in the calibration of pivots
/// [Yaniv15]. Not found where fewer than five photographs or fewer than half of those that are
/// posed fit, where the sheet turns by less than 20 degrees, or where the axis leans by more than
/// 15 degrees.
TurntableMotion find_turntable(const PoseResult& result);

}  // namespace photohull
