// What several files that commands write have in common, as JSON.
#pragma once

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "core/camera.h"

namespace photohull::pose {

/// null where it is infinite or no number, which JSON cannot say.
nlohmann::ordered_json finite_or_null(double value);
nlohmann::ordered_json vector_json(const glm::dvec3& v);
/// Sets "R", by rows, and "t".
void add_pose_json(const Pose& pose, nlohmann::ordered_json& j);

}  // namespace photohull::pose
