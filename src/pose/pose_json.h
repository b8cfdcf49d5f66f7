// What photohull pose found out, for programs.
#pragma once

#include <string>
#include <vector>

#include "calib/pose_photographs.h"
#include "pose/pose_turntable.h"

namespace photohull::pose {

/// pose.json. `names` has one for each photograph.
std::string pose_json(const std::vector<std::string>& names, const PoseResult& result,
                      const TurntableFinding& turntable);

}  // namespace photohull::pose
