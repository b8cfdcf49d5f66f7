#include "pipeline/report.h"

#include <sys/resource.h>
#include <cmath>

#include <nlohmann/json.hpp>

namespace photohull::pipeline {

using nlohmann::ordered_json;

namespace {

ordered_json to_json_array(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
ordered_json to_json_array(const glm::ivec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

std::string Report::to_json() const {
  ordered_json j;
  j["photohull"] = version;
  j["scene"] = {{"path", scene}, {"format", format}, {"views", views}};
  j["photographs"] = {{"listed", photographs_listed},
                      {"scaled", photographs_scaled},
                      {"passed_over", photographs_passed_over},
                      {"left_out", ordered_json::array()}};
  for (const LeftOutView& v : photographs_left_out)
    j["photographs"]["left_out"].push_back(
        {{"name", v.name}, {"reason", to_string(v.reason)}, {"detail", v.detail}});
  j["inputs"] = ordered_json::array();
  for (const InputFile& f : inputs)
    j["inputs"].push_back({{"kind", f.kind},
                           {"path", f.path.string()},
                           {"bytes", f.bytes},
                           {"xxh3_128", f.xxh3_128}});
  j["device"] = device;
  for (const auto& [name, value] : options) j["options"][name] = value;
  j["box"] = {
      {"min", to_json_array(box.min)}, {"max", to_json_array(box.max)}, {"source", box_source}};
  j["image_scale"] = {{"smallest", smallest_scale}, {"largest", largest_scale}};
  j["masks"] = {{"source", mask_source},
                {"confidence", mask_confidence},
                {"mended", masks_mended},
                {"offset", mask_offset}};
  if (std::isfinite(mask_disagreement)) j["masks"]["disagreement"] = mask_disagreement;
  j["masks"]["full_evidence"] = full_evidence;
  j["masks"]["views"] = ordered_json::array();
  for (const MaskReport& m : masks)
    j["masks"]["views"].push_back(
        {{"name", m.view}, {"source", m.source}, {"confidence", m.confidence}});
  j["thin_parts"] = {
      {"line_pixels", thin.line_pixels},         {"looked_at", thin.looked_at},
      {"unexplained", thin.unexplained},         {"placed", thin.placed},
      {"restored_pixels", thin.restored_pixels}, {"stem_vertices", thin.stem_vertices}};
  if (!missing_view.empty()) j["thin_parts"]["missing_png_shows"] = missing_view;
  if (!thin.worst_view.empty()) j["thin_parts"]["worst_view"] = thin.worst_view;
  j["noise_sigma"] = noise_sigma;
  j["grid"] = {{"origin", to_json_array(grid.origin)},
               {"voxel_size", grid.voxel_size},
               {"voxels", to_json_array(grid.voxels())},
               {"bricks_stored", bricks_stored}};
  if (!camera_refinement.empty()) j["camera_refinement"] = ordered_json::parse(camera_refinement);
  if (!photometric.empty()) j["photometric"] = ordered_json::parse(photometric);
  j["left_out"] = left_out;
  for (const auto& [view, value] : sharpness)
    j["sharpness"].push_back({{"name", view}, {"sharpness", value}});
  j["masks"]["left_out"] = masks_left_out;
  for (const OutlineRoom& r : outline_room) j["masks"]["outline_room_pixels"][r.view] = r.pixels;
  if (!verdict_json.empty()) j["verdict"] = ordered_json::parse(verdict_json);
  if (!explained_view.empty()) j["verdict"]["explained_png_shows"] = explained_view;
  j["stages"] = ordered_json::array();
  for (const StageReport& s : stages)
    j["stages"].push_back({{"name", s.name},
                           {"wall_seconds", s.wall_seconds},
                           {"cpu_seconds", s.cpu_seconds},
                           {"samples", s.samples},
                           {"peak_memory_bytes", s.peak_memory_bytes}});
  j["hull"] = {{"nodes_tested", nodes_tested}, {"bricks_evaluated", bricks_evaluated}};
  j["photo"] = {{"sweeps", sweeps},
                {"voxels_judged", voxels_judged},
                {"voxels_carved", voxels_carved},
                {"voxels_undecided", voxels_undecided}};
  if (sampling) {
    j["photo"]["sampler"] = sampling->sampler;
    j["photo"]["supersample"] = sampling->supersample;
    j["photo"]["consistency"] = sampling->consistency;
    j["photo"]["visibility"] = sampling->visibility;
    j["photo"]["r_consistency"] = sampling->r_consistency;
  }
  j["resumed_levels"] = resumed_levels;
  j["refine"] = ordered_json::array();
  for (const RefineLevelReport& level : refine_levels)
    j["refine"].push_back({{"voxel_size", level.voxel_size},
                           {"wall_seconds", level.wall_seconds},
                           {"surfels", level.surfels},
                           {"evidence", level.evidence},
                           {"samples", level.samples},
                           {"bricks", level.bricks},
                           {"restored_voxels", level.restored},
                           {"freed_voxels", level.freed},
                           {"bricks_split", level.split},
                           {"bricks_settled",
                            {{"pixels", level.settled_pixels},
                             {"plain", level.settled_plain},
                             {"flat", level.settled_flat}}},
                           {"mean_move_voxels", level.mean_move}});
  j["refine_fits"] = ordered_json::array();
  for (const RefineFitReport& fit : refine_fits)
    j["refine_fits"].push_back({{"wall_seconds", fit.wall_seconds},
                                {"held_out_score", fit.held_out},
                                {"held_out_score_fitted", fit.held_out_fitted},
                                {"mean_move_voxels", fit.mean_move},
                                {"kept", fit.kept}});
  j["voxels_kept"] = voxels_kept;
  j["mesh"] = {{"vertices", vertices},
               {"triangles", triangles},
               {"uniform_triangles", uniform_triangles},
               {"sharpened_vertices", sharpened_vertices},
               {"unseen_share", unseen_share},
               {"islands_removed", islands},
               {"islands_area_share", islands_area_share}};
  j["surroundings"] = ordered_json::array();
  for (const ShellReport& shell : surroundings)
    j["surroundings"].push_back(
        {{"box", {{"min", to_json_array(shell.box.min)}, {"max", to_json_array(shell.box.max)}}},
         {"voxel_size", shell.voxel_size},
         {"voxels", to_json_array(shell.voxels)},
         {"triangles", shell.triangles},
         {"area_share", shell.area_share}});
  if (mesh_error)
    j["mesh"]["error_voxels"] = {{"limit", mesh_error->limit},
                                 {"mean", mesh_error->mean},
                                 {"p95", mesh_error->p95},
                                 {"p999", mesh_error->p999},
                                 {"max", mesh_error->max}};
  j["wall_seconds"] = wall_seconds;
  j["cpu_seconds"] = cpu_seconds;
  j["peak_memory_bytes"] = peak_memory_bytes;
  j["warnings"] = warnings;
  j["files"] = files;
  // File names need not be UTF-8, JSON must.
  return j.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

double process_cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

std::int64_t process_peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t(usage.ru_maxrss) * 1024;
}

}  // namespace photohull::pipeline
