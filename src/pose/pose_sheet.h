// Cameras of photographs of an object on a printed sheet.
#pragma once

#include <string>

#include "calib/pose_photographs.h"
#include "core/progress.h"
#include "core/scene.h"
#include "pose/pose_job.h"
#include "pose/pose_turntable.h"

namespace photohull::pose {

/// What was found, with an entry for each image of the job.
struct SheetPose {
  PoseResult result;
  TurntableFinding turntable;
  std::string report;  ///< pose.json
  Scene scene;         ///< transforms.json
};

/// Writes transforms.json, pose.json and, where the job wants them, masks/ into the job's folder.
/// Photographs that cannot be read or posed are left out. Throws as pose_photographs does, and
/// Error for a board's description or a folder that is not usable.
SheetPose pose_on_sheet(const PoseJob& job, Progress& progress);

}  // namespace photohull::pose
