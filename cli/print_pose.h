// What photohull pose found out, for people: a few lines on standard output.
#pragma once

#include <string>
#include <vector>

#include "pose/pose_colmap.h"
#include "pose/pose_turntable.h"

namespace photohull::cli {

/// `names` has one for each photograph.
void print_pose(const std::vector<std::string>& names, const PoseResult& result,
                const pose::TurntableFinding& turntable);

void print_colmap_pose(const pose::PoseJob& job, const pose::ColmapPose& pose);

}  // namespace photohull::cli
