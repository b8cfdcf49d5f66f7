// Photographs of an object that was laid on another side in between: a pose each by the sheet, then
// all in one scene.
#pragma once

#include <string>
#include <vector>

#include "cameras/join_passes.h"
#include "pose/pose_job.h"
#include "pose/pose_sheet.h"

namespace photohull::pose {

/// A pass, posed in its own world, and how it lies to the first one.
struct PosedPass {
  PoseJob job;
  SheetPose pose;
  JoinedPass joined;
};

struct PassesPose {
  std::vector<PosedPass> passes;
  std::vector<std::string> warnings;
  std::string report;  ///< pose.json
};

/// Poses each pass by the sheet into pass1/, pass2/ ... of the job's folder, as photohull pose
/// does, and joins them in the first one's world (join_passes): writes transforms.json and
/// pose.json into the job's folder. Views are called PASS/NAME. The box is what the masks of
/// all passes leave (carving/object_box.h) of what the passes' boxes have in common, each down to
/// below its sheet, for other passes show what stood on it. Throws as
/// pose_on_sheet and join_passes do, and Error for a sheet around a cylinder
/// and for a photograph that two passes have.
PassesPose pose_passes(const PoseJob& job, Progress& progress);

/// The weights of its stages together.
double passes_weight(const PoseJob& job);

/// A turn by so many degrees about an axis, right-hand rule; no turn is one about z.
struct AxisTurn {
  glm::dvec3 axis{0, 0, 1};
  double degrees = 0;
};
AxisTurn axis_turn(const glm::dmat3& rotation);

/// pose.json of the joined scene. `scene`: with the views of all passes.
std::string passes_json(const std::vector<PosedPass>& passes, const Scene& scene,
                        const std::vector<std::string>& warnings);

}  // namespace photohull::pose
