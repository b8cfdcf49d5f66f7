// Whether what boards gave can be a camera, and is good enough to reconstruct with.
#pragma once

#include <string>
#include <vector>

#include "calib/calibrate_rig.h"

namespace photohull {

struct CalibrationJudgement {
  /// One sentence: what was found that cannot be right or is of no use, and what to photograph or
  /// state instead. Empty: none.
  std::string refusal;
  std::vector<std::string> doubts;  ///< the same of what is poor but may serve
  bool misfits = false;             ///< the boards do not fit: another board than stated might
};

/// Refused: focal lengths or principal points that no camera has; boards that fit, or points of an
/// object that are certain (Calibration::object_error), to 2 pixels or a thousandth of the
/// picture's diagonal only, whichever is more. Doubtful: a quarter of that; principal points far
/// from the middle, pixels that are not square, or most boards left out.
CalibrationJudgement judge_calibration(const std::vector<BoardView>& views, const Calibration& c);
CalibrationJudgement judge_calibration(const RigCalibration& rig);

}  // namespace photohull
