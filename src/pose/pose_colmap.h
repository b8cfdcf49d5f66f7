// photohull pose with COLMAP: photographs without a printed sheet.
#pragma once

#include <string>
#include <vector>

#include "calib/adjust_lenses.h"
#include "core/progress.h"
#include "io/run_colmap.h"
#include "pose/pose_job.h"

namespace photohull::pose {

/// Writes transforms.json, points.ply and pose.json into the job's folder, and COLMAP's work into
/// colmap/ there, whose cameras are those before lenses are adjusted. What it found comes back for
/// print_colmap_pose, with one entry for each image of the job. Photographs that cannot be read are
/// left out. Throws as io::run_colmap and io::find_masks do.
struct ColmapPose {
  io::ColmapFound found;
  std::vector<AdjustedLens> lenses;  ///< none where COLMAP's cameras are taken as they are
  std::string report;                ///< pose.json
  std::vector<std::string> warnings;
};
ColmapPose pose_with_colmap(const PoseJob& job, Progress& progress);

}  // namespace photohull::pose
