#include "calibration_json.h"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "pose/json_parts.h"

namespace photohull::cli {
namespace {

using nlohmann::ordered_json;
using pose::add_pose_json, pose::finite_or_null, pose::vector_json;

void add_lens(const Intrinsics& k, const Distortion& distortion, LensModel lens, ordered_json& j) {
  j["image_width"] = k.width;
  j["image_height"] = k.height;
  j["camera_matrix"] = {{k.fx, 0.0, k.cx}, {0.0, k.fy, k.cy}, {0.0, 0.0, 1.0}};
  j["model"] = to_string(lens);
  j["distortion_coefficients"] = distortion.coefficients;
}

ordered_json view_json(const BoardView& view, double rms, bool left_out) {
  return {{"name", view.name},
          {"points", view.points.size()},
          {"rms", finite_or_null(rms)},
          {"left_out", left_out}};
}

std::string text_of(const ordered_json& j) {
  return j.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

void print_view(const BoardView& view, double rms, bool left_out) {
  if (view.points.empty())
    std::printf("%-32s board not found\n", view.name.c_str());
  else if (std::isnan(rms))
    std::printf("%-32s only %zu points of the board found, left out\n", view.name.c_str(),
                view.points.size());
  else
    std::printf("%-32s %7.3f px over %zu points%s\n", view.name.c_str(), rms, view.points.size(),
                left_out ? ", left out" : "");
}

void print_lens(const Intrinsics& k, bool known, double focal_sigma, double principal_sigma,
                double rms) {
  const auto print = [known](const char* name, double x, double y, double sigma) {
    std::printf("%-16s %.3f, %.3f", name, x, y);
    if (known)
      std::printf(" px, known\n");
    else
      std::printf(" +- %.3f px\n", sigma);
  };
  print("focal length", k.fx, k.fy, focal_sigma);
  print("principal point", k.cx, k.cy, principal_sigma);
  std::printf("reprojection     %.4f px rms\n", rms);
}

void print_object_error(double error) { std::printf("at the object    +- %.4f px\n", error); }

}  // namespace

std::string calibration_json(const std::vector<BoardView>& views, const Calibration& c,
                             const std::vector<std::string>& warnings) {
  ordered_json j;
  j["photohull_calibration"] = c.turntable ? "turntable" : "camera";
  add_lens(c.intrinsics, c.distortion, c.model, j);
  j["rms"] = c.all_rms;
  j["focal_sigma"] = c.focal_sigma;
  j["principal_point_sigma"] = c.principal_sigma;
  j["lens_known"] = c.lens_known;
  j["object_error"] = finite_or_null(c.object_error);
  j["warnings"] = warnings;
  if (c.turntable)
    j["turntable"] = {{"axis", vector_json(c.turntable->direction)},
                      {"point", vector_json(c.turntable->point)},
                      {"angles_given", c.turntable->angles_given},
                      {"axis_sigma_degrees", c.turntable->direction_sigma},
                      {"point_sigma", c.turntable->point_sigma},
                      {"angle_sigma_degrees", c.turntable->angle_sigma}};
  j["views"] = ordered_json::array();
  for (std::size_t i = 0; i < views.size(); ++i) {
    ordered_json view = view_json(views[i], c.rms[i], c.left_out[i]);
    if (!c.left_out[i]) {
      add_pose_json(c.cam_from_board[i], view);
      if (c.turntable) view["angle_degrees"] = c.turntable->angles[i];
    }
    j["views"].push_back(view);
  }
  return text_of(j);
}

std::string rig_json(const std::vector<RigCameraViews>& views,
                     const std::vector<std::string>& moments, const RigCalibration& rig,
                     const std::vector<std::string>& warnings) {
  ordered_json j;
  j["photohull_calibration"] = "rig";
  j["rms"] = rig.all_rms;
  j["object_error"] = finite_or_null(rig.object_error);
  j["warnings"] = warnings;
  j["cameras"] = ordered_json::array();
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const RigCamera& camera = rig.cameras[c];
    ordered_json entry;
    entry["name"] = camera.name;
    add_lens(camera.intrinsics, camera.distortion, camera.model, entry);
    add_pose_json(camera.cam_from_rig, entry);
    entry["rms"] = camera.all_rms;
    entry["focal_sigma"] = camera.focal_sigma;
    entry["principal_point_sigma"] = camera.principal_sigma;
    entry["lens_known"] = camera.lens_known;
    entry["rotation_sigma_degrees"] = camera.rotation_sigma;
    entry["translation_sigma"] = camera.translation_sigma;
    entry["views"] = ordered_json::array();
    for (std::size_t m = 0; m < moments.size(); ++m) {
      if (views[c].views[m].name.empty()) continue;  // no picture
      ordered_json view = view_json(views[c].views[m], camera.rms[m], camera.left_out[m]);
      view["moment"] = moments[m];
      entry["views"].push_back(view);
    }
    j["cameras"].push_back(entry);
  }
  return text_of(j);
}

void print_calibration(const std::vector<BoardView>& views, const Calibration& c) {
  for (std::size_t i = 0; i < views.size(); ++i) print_view(views[i], c.rms[i], c.left_out[i]);
  print_lens(c.intrinsics, c.lens_known, c.focal_sigma, c.principal_sigma, c.all_rms);
  print_object_error(c.object_error);
  if (!c.turntable) return;
  const TurntableAxis& t = *c.turntable;
  std::printf("axis             %.6f %.6f %.6f +- %.4f degrees\n", t.direction.x, t.direction.y,
              t.direction.z, t.direction_sigma);
  std::printf("through          %g %g %g +- %.2g\n", t.point.x, t.point.y, t.point.z,
              t.point_sigma);
  if (t.angles_given)
    std::printf("angles           as given\n");
  else
    std::printf("angles           found, +- %.4f degrees at most\n", t.angle_sigma);
}

void print_rig(const std::vector<RigCameraViews>& views, const RigCalibration& rig) {
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const RigCamera& camera = rig.cameras[c];
    std::printf("camera %s\n", camera.name.c_str());
    for (std::size_t m = 0; m < views[c].views.size(); ++m)
      if (!views[c].views[m].name.empty())
        print_view(views[c].views[m], camera.rms[m], camera.left_out[m]);
    print_lens(camera.intrinsics, camera.lens_known, camera.focal_sigma, camera.principal_sigma,
               camera.all_rms);
    const Pose& pose = camera.cam_from_rig;
    const glm::dvec3 center = -(glm::transpose(pose.rotation) * pose.translation);
    std::printf("centre           %g %g %g; turned +- %.4f degrees, moved +- %.2g\n", center.x,
                center.y, center.z, camera.rotation_sigma, camera.translation_sigma);
  }
  std::printf("all              %.4f px rms\n", rig.all_rms);
  print_object_error(rig.object_error);
}

}  // namespace photohull::cli
