#include "pipeline/refine_cameras.h"

#include <nlohmann/json.hpp>

#include "core/error.h"

namespace photohull::pipeline {

const char* to_string(RefineCameras refine) {
  switch (refine) {
    case RefineCameras::kOff:
      return "off";
    case RefineCameras::kAuto:
      return "auto";
    case RefineCameras::kPoses:
      return "poses";
    case RefineCameras::kPosesAndIntrinsics:
      return "poses+intrinsics";
  }
  return "unknown";
}

void apply(const CameraRefinement& refinement, std::span<SourceView> views) {
  PHOTOHULL_CHECK_OP(refinement.cameras.size(), ==, views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    Camera& camera = views[i].camera;
    camera.cam_from_world = refinement.cameras[i].cam_from_world;
    Intrinsics& k = camera.intrinsics;
    k.fx *= refinement.focal_factor, k.fy *= refinement.focal_factor;
    k.skew *= refinement.focal_factor;
    k.cx += refinement.principal.x, k.cy += refinement.principal.y;
  }
}

bool pays(const CameraRefinement& r) {
  constexpr double kLeastGain = 0.8, kLeastResidual = 0.2;  // pixels
  constexpr double kSharedGain = 0.5;
  const auto falls = [](double before, double after) {
    return after < kLeastGain * before && before > kLeastResidual;
  };
  // What all views share bends the surface more than residuals show.
  if (shares_intrinsics(r) && r.all.after < kSharedGain * r.all.before) return true;
  return r.changed && (r.all.observations > 0 ? falls(r.all.before, r.all.after)
                                              : falls(r.tangents_before, r.tangents_after));
}

bool shares_intrinsics(const CameraRefinement& r) {
  return r.focal_factor != 1 || r.principal != glm::dvec2(0);
}

std::string to_json(const CameraRefinement& r, const Scene& scene, bool used) {
  nlohmann::ordered_json j;
  j["changed"] = r.changed;
  j["used"] = used;
  j["tracks"] = r.tracks;
  j["given_tracks"] = r.given_tracks;
  j["surface_patches"] = r.patches;
  j["tangents"] = r.tangents;
  j["rounds"] = r.rounds;
  j["residual_before"] = r.all.before;
  j["residual_after"] = r.all.after;
  j["held_out_observations"] = r.all.observations;
  j["tangents_before"] = r.tangents_before;
  j["tangents_after"] = r.tangents_after;
  j["moved"] = r.moved;
  j["moved_alike"] = r.moved_alike;
  j["focal_factor"] = r.focal_factor;
  j["principal_point_offset"] = {r.principal.x, r.principal.y};
  j["views"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < scene.views.size(); ++i)
    j["views"].push_back({{"name", scene.views[i].name},
                          {"before", r.views[i].before},
                          {"after", r.views[i].after},
                          {"observations", r.views[i].observations}});
  return j.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace photohull::pipeline
