#include "pose/json_parts.h"

#include <cmath>

namespace photohull::pose {

using nlohmann::ordered_json;

ordered_json finite_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

ordered_json vector_json(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

void add_pose_json(const Pose& pose, ordered_json& j) {
  const glm::dmat3& r = pose.rotation;
  j["R"] = {{r[0][0], r[1][0], r[2][0]}, {r[0][1], r[1][1], r[2][1]}, {r[0][2], r[1][2], r[2][2]}};
  j["t"] = vector_json(pose.translation);
}

}  // namespace photohull::pose
