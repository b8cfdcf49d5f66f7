// What photohull pose found out, for programs and for people.
#pragma once

#include <string>
#include <vector>

#include "calib/pose_photographs.h"
#include "pose_turntable.h"

namespace photohull::cli {

/// pose.json. `names` has one for each photograph.
std::string pose_json(const std::vector<std::string>& names, const PoseResult& result,
                      const TurntableFinding& turntable);

/// A few lines on standard output.
void print_pose(const std::vector<std::string>& names, const PoseResult& result,
                const TurntableFinding& turntable);

}  // namespace photohull::cli
