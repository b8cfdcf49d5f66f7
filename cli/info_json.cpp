#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "info_output.h"

namespace photohull::cli {
namespace {

const char* to_string(ViewFit::By by) {
  switch (by) {
    case ViewFit::By::kMatches:
      return "matches";
    case ViewFit::By::kSilhouettes:
      return "silhouettes";
    case ViewFit::By::kTracks:
      return "tracks";
  }
  return "unknown";
}

/// Infinite and undefined numbers become null.
nlohmann::ordered_json diagnosis_json(const CameraDiagnosis& d, const Scene& scene) {
  nlohmann::ordered_json j = {{"pairs", d.pairs}, {"matches", d.matches}, {"misread", d.misread}};
  for (const PoseReading& r : d.readings)
    j["readings"].push_back({{"reading", to_string(r)},
                             {"inverted", r.inverted},
                             {"flipped", r.flipped},
                             {"explained", r.explained},
                             {"residual", r.residual}});
  for (std::size_t i = 0; i < d.views.size(); ++i)
    j["views"].push_back({{"name", scene.views[i].name},
                          {"residual", d.views[i].residual},
                          {"others", d.views[i].others},
                          {"count", d.views[i].count},
                          {"by", to_string(d.views[i].by)},
                          {"disagrees", d.views[i].disagrees}});
  if (d.pixel_centre) {
    const PixelCentreFit& f = *d.pixel_centre;
    j["pixel_centre"] = {{"tells", f.tells},
                         {"best", f.best},
                         {"shift", f.shift},
                         {"sigma", f.sigma},
                         {"shifts", PixelCentreFit::kShifts},
                         {"tracks_rms", f.tracks},
                         {"tracks", f.track_count},
                         {"tangents_rms", f.tangents},
                         {"tangents", f.tangent_count}};
  }
  if (d.box)
    j["box"] = {{"seen_by", d.box->seen_by},
                {"cameras_inside", d.box->cameras_inside},
                {"diagonal", d.box->diagonal},
                {"distance", d.box->distance},
                {"points", d.box->points},
                {"points_inside", d.box->points_inside},
                {"points_diagonal", d.box->points_diagonal},
                {"points_distance", d.box->points_distance}};
  j["faults"] = d.faults;
  j["notes"] = d.notes;
  return j;
}

nlohmann::ordered_json box_json(const Box& b) {
  return {{"min", {b.min.x, b.min.y, b.min.z}}, {"max", {b.max.x, b.max.y, b.max.z}}};
}

void add_extents(const pipeline::Inspection& info, nlohmann::ordered_json& j) {
  const pipeline::Extents& e = info.extents;
  j["cameras_extent"] = box_json(e.cameras);
  j["points"] = {{"count", info.scene.points.size()}, {"extents", nlohmann::ordered_json::array()}};
  for (const pipeline::Extents::Share& s : e.points) {
    nlohmann::ordered_json share = box_json(s.box);
    share["quantiles"] = {s.low, s.high};
    j["points"]["extents"].push_back(share);
  }
  if (info.suggested_box) j["suggested_box"] = box_json(*info.suggested_box);
  try {
    if (info.failure) std::rethrow_exception(info.failure);
  } catch (const std::exception& failure) {
    j["failure"] = failure.what();
  }
}

nlohmann::ordered_json masks_json(const PreparedViews& prepared) {
  nlohmann::ordered_json j = {{"source", prepared.mask_source},
                              {"confidence", prepared.mask_confidence},
                              {"views", nlohmann::ordered_json::array()},
                              {"warnings", prepared.warnings}};
  for (std::size_t i = 0; i < prepared.masks.size(); ++i)
    j["views"].push_back({{"name", prepared.views[i].name},
                          {"source", prepared.masks[i].source},
                          {"confidence", prepared.masks[i].confidence}});
  return j;
}

}  // namespace

void print_info_json(const pipeline::Inspection& info, const PreparedViews* masks,
                     const CameraDiagnosis* diagnosis) {
  nlohmann::ordered_json j;
  j["format"] = to_string(info.scene.format);
  for (const SourceView& v : info.scene.views) {
    const Intrinsics& k = v.camera.intrinsics;
    const glm::dvec3 c = v.camera.center();
    j["views"].push_back({{"name", v.name},
                          {"width", k.width},
                          {"height", k.height},
                          {"fx", k.fx},
                          {"fy", k.fy},
                          {"skew", k.skew},
                          {"cx", k.cx},
                          {"cy", k.cy},
                          {"centre", {c.x, c.y, c.z}},
                          {"mask", v.mask.string()}});
  }
  j["listed"] = info.scene.listed.size();
  j["left_out"] = nlohmann::ordered_json::array();
  for (const LeftOutView& v : info.scene.left_out)
    j["left_out"].push_back(
        {{"name", v.name}, {"reason", to_string(v.reason)}, {"detail", v.detail}});
  if (info.scene.box) {
    const Box& b = *info.scene.box;
    j["box"] = box_json(b);
    j["box"]["source"] = info.scene.box_source;
  }
  add_extents(info, j);
  if (!info.scales.empty()) {
    j["nearest_angle_degrees"] = info.nearest_angle;
    j["farthest_angle_degrees"] = info.farthest_angle;
    j["pixel_footprint"] = info.voxel_size;
    j["normal_voxel_size"] =
        info.voxel_size * pipeline::footprint_factor(pipeline::Quality::kNormal, info.silhouettes);
    j["voxel_size"] = info.grid.voxel_size;
    j["image_scale"] = *std::min_element(info.scales.begin(), info.scales.end());
    j["matched_scale"] = *std::min_element(info.matched.begin(), info.matched.end());
    j["memory_limit_bytes"] = info.memory_limit;
    j["memory_bytes"] = info.memory_bytes;
    j["cpu_seconds"] = info.cpu_seconds;
  }
  if (diagnosis) j["cameras"] = diagnosis_json(*diagnosis, info.scene);
  if (masks) j["masks"] = masks_json(*masks);
  j["warnings"] = info.warnings;
  std::printf("%s\n",
              j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace).c_str());
}

}  // namespace photohull::cli
