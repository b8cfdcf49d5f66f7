// The files that `photohull calibrate` writes (docs/guide/cameras.md).
#pragma once

#include <string>
#include <vector>

#include "calib/calibrate_rig.h"

namespace photohull::cli {

/// A camera, or with calibration.turntable a turntable. `warnings`: what is doubtful in it.
std::string calibration_json(const std::vector<BoardView>& views, const Calibration& calibration,
                             const std::vector<std::string>& warnings);
std::string rig_json(const std::vector<RigCameraViews>& views,
                     const std::vector<std::string>& moments, const RigCalibration& rig,
                     const std::vector<std::string>& warnings);

/// For people, on standard output.
void print_calibration(const std::vector<BoardView>& views, const Calibration& calibration);
void print_rig(const std::vector<RigCameraViews>& views, const RigCalibration& rig);

}  // namespace photohull::cli
