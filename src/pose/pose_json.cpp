#include "pose/pose_json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "pose/json_parts.h"

namespace photohull::pose {
namespace {

using nlohmann::ordered_json;

ordered_json camera_json(const PosedCamera& c) {
  const Intrinsics& k = c.intrinsics;
  return {
      {"name", c.name},
      {"photographs", c.photographs},
      {"width", k.width},
      {"height", k.height},
      {"focal_length", {k.fx, k.fy}},
      {"principal_point", {k.cx, k.cy}},
      {"distortion", c.distortion.coefficients},
      {"stated_focal_length", c.stated_focal > 0 ? ordered_json(c.stated_focal) : ordered_json()},
      {"focal_sigma", finite_or_null(c.focal_sigma)},
      {"principal_point_sigma", finite_or_null(c.principal_sigma)}};
}

ordered_json photo_json(const std::string& name, const PosedPhoto& p) {
  ordered_json j = {{"name", name}, {"posed", p.posed}, {"tags_found", p.tags_found}};
  if (!p.posed) {
    j["reason"] = p.reason;
    return j;
  }
  j["tags_used"] = p.tags_used;
  j["camera"] = p.camera;
  j["rms"] = finite_or_null(p.rms);
  j["rotation_sigma_degrees"] = p.turn_sigma;
  j["position_sigma"] = p.place_sigma;
  add_pose_json(p.cam_from_world, j);
  return j;
}

ordered_json turntable_json(const TurntableFinding& table) {
  ordered_json j = {{"found", table.found()}};
  if (!table.found()) j["reason"] = table.reason();
  if (table.stations.empty()) return j;
  const TurntableMotion& motion = table.motion;
  j["axis"] = {{"point", vector_json(motion.point)}, {"direction", vector_json(motion.direction)}};
  j["rms_degrees"] = motion.rms_degrees;
  j["rms_length"] = motion.rms_length;
  j["background_still"] = table.found();
  j["stations"] = ordered_json::array();
  for (std::size_t s = 0; s < table.stations.size(); ++s)
    j["stations"].push_back({{"camera", motion.stations[s].camera},
                             {"photographs", motion.stations[s].photos.size()},
                             {"background", to_string(table.stations[s].stillness)},
                             {"edges_kept", table.stations[s].edges_kept}});
  return j;
}

}  // namespace

std::string pose_json(const std::vector<std::string>& names, const PoseResult& result,
                      const TurntableFinding& turntable) {
  ordered_json j;
  j["photohull_pose"] = 1;
  j["rms"] = finite_or_null(result.rms);
  j["object_error"] = finite_or_null(result.object_error);
  j["world_units_per_mm"] = result.scale;
  j["box"] = {vector_json(result.box.min), vector_json(result.box.max)};
  const SheetBend& b = result.bend;
  j["bend"] = {{"found", b.found}, {"xx", b.xx},         {"xy", b.xy},
               {"yy", b.yy},       {"height", b.height}, {"height_sigma", b.height_sigma}};
  j["turntable"] = turntable_json(turntable);
  j["warnings"] = result.warnings;
  j["cameras"] = ordered_json::array();
  for (const PosedCamera& camera : result.cameras) j["cameras"].push_back(camera_json(camera));
  j["photographs"] = ordered_json::array();
  for (std::size_t i = 0; i < names.size(); ++i) {
    ordered_json photo = photo_json(names[i], result.photos[i]);
    if (const int station = turntable.station_of(i); station >= 0)
      photo["turntable"] = {{"station", station}, {"angle", turntable.motion.angles[i]}};
    j["photographs"].push_back(std::move(photo));
  }
  return j.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace photohull::pose
