#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "pose/json_parts.h"
#include "pose/pose_passes.h"

namespace photohull::pose {
namespace {

using nlohmann::ordered_json;

ordered_json motion_json(const JoinedPass& pass) {
  const AxisTurn turn = axis_turn(pass.motion.rotation);
  return {{"axis", vector_json(turn.axis)},
          {"angle", turn.degrees},
          {"translation", vector_json(pass.motion.translation)},
          {"rotation_sigma_degrees", pass.turn_sigma},
          {"position_sigma", pass.move_sigma},
          {"matches", pass.matches},
          {"tracks", pass.tracks},
          {"seam", finite_or_null(pass.seam)},
          {"seam_sigma", pass.seam_sigma},
          {"outside", pass.outside}};
}

int posed_photos(const PosedPass& pass) { return int(pass.pose.scene.views.size()); }

}  // namespace

AxisTurn axis_turn(const glm::dmat3& r) {
  const glm::dquat q = glm::normalize(glm::quat_cast(r));
  const glm::dvec3 v(q.x, q.y, q.z);
  const double sine = glm::length(v);
  if (sine < 1e-12) return {};
  const double turn = 2 * std::atan2(sine, std::abs(q.w));
  return {(q.w < 0 ? -v : v) / sine, glm::degrees(turn)};
}

std::string passes_json(const std::vector<PosedPass>& passes, const Scene& scene,
                        const std::vector<std::string>& warnings) {
  ordered_json j;
  j["photohull_pose"] = 1;
  j["world_units_per_mm"] = passes.front().pose.result.scale;
  j["box"] = {vector_json(scene.box->min), vector_json(scene.box->max)};
  j["warnings"] = warnings;
  j["passes"] = ordered_json::array();
  j["photographs"] = ordered_json::array();
  std::size_t view = 0;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const PosedPass& pass = passes[i];
    ordered_json one = {{"folder", pass.job.out.filename().string()},
                        {"photographs", posed_photos(pass)},
                        {"points", pass.joined.points}};
    if (i > 0) one["motion"] = motion_json(pass.joined);
    j["passes"].push_back(std::move(one));
    for (std::size_t k = 0; k < pass.job.names.size(); ++k) {
      const PosedPhoto& photo = pass.pose.result.photos[k];
      ordered_json entry = {{"name", pass.job.names[k]}, {"pass", i}, {"posed", photo.posed}};
      if (photo.posed)
        add_pose_json(scene.views[view++].camera.cam_from_world, entry);
      else
        entry["reason"] = photo.reason;
      j["photographs"].push_back(std::move(entry));
    }
  }
  return j.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace photohull::pose
