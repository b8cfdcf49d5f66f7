#include <cmath>
#include <cstdio>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>

#include "json_parts.h"
#include "pose_json.h"
#include "pose_passes.h"

namespace photohull::cli {
namespace {

using nlohmann::ordered_json;

/// Turn by so many degrees about an axis, right-hand rule; no turn is one about z.
struct AxisTurn {
  glm::dvec3 axis{0, 0, 1};
  double degrees = 0;
};

AxisTurn axis_turn(const glm::dmat3& r) {
  const glm::dquat q = glm::normalize(glm::quat_cast(r));
  const glm::dvec3 v(q.x, q.y, q.z);
  const double sine = glm::length(v);
  if (sine < 1e-12) return {};
  const double turn = 2 * std::atan2(sine, std::abs(q.w));
  return {(q.w < 0 ? -v : v) / sine, glm::degrees(turn)};
}

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

void print_passes(const std::vector<PosedPass>& passes) {
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const PosedPass& pass = passes[i];
    std::printf("pass %zu\n", i + 1);
    print_pose(pass.job.names, pass.pose.result, pass.pose.turntable);
    if (i == 0) continue;
    const AxisTurn turn = axis_turn(pass.joined.motion.rotation);
    std::printf(
        "the object      lay turned by %.3f +- %.3f degrees about (%.3f, %.3f, %.3f), moved by "
        "+- %.3g units; %d features\n",
        turn.degrees, pass.joined.turn_sigma, turn.axis.x, turn.axis.y, turn.axis.z,
        pass.joined.move_sigma, pass.joined.tracks);
    std::printf("seam             %.3f px, +- %.3f px by the motion\n", pass.joined.seam,
                pass.joined.seam_sigma);
  }
}

}  // namespace photohull::cli
