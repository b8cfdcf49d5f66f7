#include "eval/evaluation_json.h"

#include <nlohmann/json.hpp>

namespace photohull::eval {
namespace {

using nlohmann::ordered_json;

ordered_json optional(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json alignment(const Alignment& a) {
  const glm::dmat3& r = a.rotation;
  return {{"scale", a.scale},
          {"rotation",
           {{r[0][0], r[1][0], r[2][0]}, {r[0][1], r[1][1], r[2][1]}, {r[0][2], r[1][2], r[2][2]}}},
          {"rotation_degrees", a.degrees},
          {"translation", {a.translation.x, a.translation.y, a.translation.z}},
          {"rms", a.rms}};
}

ordered_json stats(const DistanceStats& s) {
  return {{"mean", s.mean}, {"median", s.median}, {"rms", s.rms}, {"q95", s.q95}, {"max", s.max}};
}

ordered_json scores(const std::vector<Score>& list) {
  ordered_json j = ordered_json::array();
  for (const Score& s : list)
    j.push_back({{"t", s.threshold},
                 {"t_world", s.distance},
                 {"precision", s.precision},
                 {"recall", s.recall},
                 {"f", s.f}});
  return j;
}

ordered_json normals(const std::optional<NormalError>& n) {
  if (!n) return nullptr;
  return {{"mean_degrees", n->mean},
          {"median_degrees", n->median},
          {"within_10_degrees", n->within_10}};
}

void put_part(const Part& part, double diagonal, ordered_json& j) {
  j["share"] = part.share;
  j["accuracy"] = part.accuracy;
  j["accuracy_pct_diag"] = 100 * part.accuracy / diagonal;
  j["median"] = part.to_truth.median;
  j["mean_signed"] = optional(part.mean_signed);
  j["recon_to_gt"] = stats(part.to_truth);
  j["f"] = scores(part.scores);
  j["f_absolute"] = scores(part.absolute);
  j["normals"] = normals(part.normals);
}

ordered_json volume(const Overlap& v) {
  ordered_json j;
  j["iou"] = v.known ? ordered_json(v.iou) : ordered_json(nullptr);
  if (!v.known) {
    j["reason"] = v.reason;
    return j;
  }
  j["recon"] = v.first;
  j["gt"] = v.second;
  j["intersection"] = v.intersection;
  j["union"] = v.together;
  return j;
}

ordered_json reliability(const Reliability& r) {
  ordered_json bins = ordered_json::array();
  for (const ReliabilityBin& b : r.bins)
    bins.push_back({{"low", b.low},
                    {"high", b.high},
                    {"count", b.count},
                    {"confidence", b.confidence},
                    {"within", b.within}});
  return {{"distance", r.distance},
          {"vertices", r.seen},
          {"unseen", r.unseen},
          {"confidence", r.confidence},
          {"within", r.within},
          {"calibration_error", r.calibration_error},
          {"brier", r.brier},
          {"auc", optional(r.auc)},
          {"spearman", optional(r.spearman)},
          {"bins", bins}};
}

}  // namespace

std::string to_json(const Evaluation& e) {
  ordered_json j;
  j["recon"] = e.result_name;
  j["truth"] = e.truth_name;
  j["truth_note"] = e.truth_note;
  j["visibility"] = e.truth_has_views;
  j["mode"] = e.points ? "points" : "mesh";
  j["truth_mode"] = e.truth_is_points ? "points" : "mesh";
  if (e.alignment) j["alignment"] = alignment(*e.alignment);
  j["samples"] = e.options.samples;
  j["seed"] = e.options.seed;
  j["min_views"] = e.options.min_views;
  j["recon_vertices"] = e.vertices;
  j["recon_faces"] = e.faces;
  j["recon_area"] = e.points ? ordered_json(nullptr) : ordered_json(e.result_area);
  j["recon_points_used"] = e.result_samples;
  j["gt_diagonal"] = e.truth_diagonal;
  j["gt_faces"] = e.truth_faces;
  j["gt_points_total"] = e.truth_samples;
  j["gt_points_visible"] = e.truth_samples_seen;
  j["accuracy_q"] = kAccuracyShare;
  put_part(e.all, e.truth_diagonal, j);
  j.erase("share");
  j.erase("median");
  j["completeness_t"] = kCompletenessThreshold;
  j["completeness"] = e.completeness;
  j["gt_to_recon"] = stats(e.to_result);
  j["hausdorff95"] = e.hausdorff95;
  j["chamfer_mean"] = e.chamfer;
  put_part(e.seen, e.truth_diagonal, j["seen"]);
  j["volume"] = volume(e.volume);
  if (e.reliability) j["reliability"] = reliability(*e.reliability);
  j["warnings"] = e.warnings;
  return j.dump(2, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace photohull::eval
