// Several cameras that see the same board at the same moments.
#pragma once

#include <string>
#include <vector>

#include "calib/calibrate_board.h"

namespace photohull {

/// What a camera of the rig saw: views[m] at moment m, without points where it did not see the
/// board or has no picture.
struct RigCameraViews {
  std::string name;
  std::vector<BoardView> views;
  std::optional<KnownLens> known{};  ///< its lens is this one: only its pose is found
};

/// A camera of a calibrated rig; standard deviations are those of the joint problem.
struct RigCamera {
  std::string name;
  Intrinsics intrinsics;
  Distortion distortion;
  Pose cam_from_rig;           ///< the rig's frame is that of the first camera
  std::vector<double> rms;     ///< pixels, of each moment; NaN where the board was not found
  std::vector<bool> left_out;  ///< of each moment: not found, or an outlier
  double all_rms = 0;          ///< pixels, of the moments that count
  double focal_sigma = 0, principal_sigma = 0;  ///< pixels (largest of x, y)
  double rotation_sigma = 0;                    ///< degrees, largest of three axes; 0 for the first
  double translation_sigma = 0;         ///< world units, largest of three axes; 0 for the first
  LensModel model = LensModel::kBrown;  ///< as asked for, or that of the known lens
  bool lens_known = false;              ///< RigCameraViews::known: the lens has no deviations
};

struct RigCalibration {
  std::vector<RigCamera> cameras;    ///< in the order given
  std::vector<Pose> rig_from_board;  ///< of each moment; identity where no camera counts
  double all_rms = 0;                ///< pixels
  /// As Calibration's, of an object that fills the room in which the boards were held.
  double object_error = 0;
};

/// Each camera on its own first (calibrate()); then poses between cameras from the moments that
/// they share, along the pairs that share most; then lenses, poses of the cameras relative to the
/// first one, and poses of the board in one Ceres problem with a robust loss, from whose
/// covariance the standard deviations come. A camera's view of a moment that does not fit, worst
/// first, is left out: pictures that were not taken at the same moment show there. Throws
/// UsageError for fewer than two cameras, Error naming the camera that is not determined alone or
/// not connected to the first by moments that both see.
RigCalibration calibrate_rig(const std::vector<RigCameraViews>& cameras, LensModel lens);

}  // namespace photohull
