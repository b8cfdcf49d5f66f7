// photohull pose with COLMAP: photographs without a printed sheet.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.h"
#include "io/run_colmap.h"

namespace photohull::cli {

struct ColmapPoseJob {
  std::vector<std::filesystem::path> images;
  std::vector<std::string> names;  ///< of each image
  std::filesystem::path masks;     ///< folder; empty: none
  std::filesystem::path out;
  bool ordered = false;
};

/// Writes transforms.json and pose.json into the job's folder, and COLMAP's work into colmap/
/// there. What it found comes back for print_colmap_pose, with one entry for each image of the job.
/// Photographs that cannot be read are left out. Throws as io::run_colmap and io::find_masks do.
struct ColmapPose {
  io::ColmapFound found;
  std::string report;  ///< pose.json
};
ColmapPose pose_with_colmap(const ColmapPoseJob& job, Progress& progress);

/// A few lines on standard output.
void print_colmap_pose(const ColmapPoseJob& job, const ColmapPose& pose);

}  // namespace photohull::cli
