// Photographs of an object that was laid on another side in between: a pose each by the sheet, then
// all in one scene.
#pragma once

#include <string>
#include <vector>

#include "cameras/join_passes.h"
#include "pose_job.h"
#include "pose_sheet.h"

namespace photohull::cli {

/// Poses each pass by the sheet into pass1/, pass2/ ... of the job's folder, as photohull pose
/// does, and joins them in the first one's world (join_passes): writes transforms.json and
/// pose.json into the job's folder. Views are called PASS/NAME. The box is the first pass's, down
/// to below its sheet, for other passes show what stood on it. Prints warnings, and a summary if
/// `tell`. Returns pose.json. Throws as pose_on_sheet and join_passes do, and Error for a sheet
/// around a cylinder.
std::string pose_passes(const PoseJob& job, bool tell);

/// A pass, posed in its own world, and how it lies to the first one.
struct PosedPass {
  PoseJob job;
  SheetPose pose;
  JoinedPass joined;
};

/// pose.json of the joined scene. `scene`: with the views of all passes.
std::string passes_json(const std::vector<PosedPass>& passes, const Scene& scene,
                        const std::vector<std::string>& warnings);

/// A few lines on standard output.
void print_passes(const std::vector<PosedPass>& passes);

}  // namespace photohull::cli
