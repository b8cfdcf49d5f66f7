#include "eval/agreement_json.h"

#include <nlohmann/json.hpp>

namespace photohull::eval {
namespace {

using nlohmann::ordered_json;

ordered_json number(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json score(const PhotoScore& s) {
  ordered_json j;
  if (!s.view.empty()) j["view"] = s.view;
  j["zncc"] = number(s.zncc());
  j["zncc_predicted"] = number(s.zncc_predicted());
  j["psnr"] = number(s.psnr());
  j["mean_difference"] = number(s.mean_difference());
  j["coverage"] = number(s.coverage());
  j["predicted"] = number(s.predicted_share());
  j["excess"] = number(s.excess());
  j["silhouette_iou"] = number(s.silhouette_iou());
  j["masked"] = s.masked;
  j["pixels"] = {{"photographed", s.pixels},
                 {"foreground", s.foreground},
                 {"projected", s.projected},
                 {"covered", s.covered},
                 {"predicted", s.predicted},
                 {"judged", s.judged},
                 {"judged_predicted", s.judged_predicted}};
  return j;
}

}  // namespace

std::string to_json(const PhotoAgreement& a, const std::string& around) {
  ordered_json j = around.empty() ? ordered_json::object() : ordered_json::parse(around);
  if (around.empty()) j["recon"] = a.result_name;
  ordered_json& p = j["photos"];
  p["scene"] = a.scene;
  p["mask_source"] = a.mask_source;
  if (!a.photometric.empty()) p["photometric"] = a.photometric;
  p["lenders"] = a.lenders;
  p["window"] = a.options.window;
  p["blend"] = a.options.predict.blend;
  p["least_angle"] = a.options.predict.least_angle;
  p["most_angle"] = a.options.predict.most_angle;
  p["all"] = score(a.all);
  p["views"] = ordered_json::array();
  for (const PhotoScore& s : a.views) p["views"].push_back(score(s));
  p["worst"] = a.worst ? ordered_json(a.views[*a.worst].view) : ordered_json(nullptr);
  p["warnings"] = a.warnings;
  return j.dump(2, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace photohull::eval
