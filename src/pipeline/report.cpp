#include "pipeline/report.h"

#include <cmath>
#include <nlohmann/json.hpp>

namespace photohull::pipeline {

using nlohmann::ordered_json;

namespace {

ordered_json array_of(const glm::dvec3& v) { return {v.x, v.y, v.z}; }
ordered_json array_of(const glm::ivec3& v) { return {v.x, v.y, v.z}; }

void add_scene(const Report& r, ordered_json& j) {
  j["photohull"] = r.version;
  j["scene"] = {{"path", r.scene.path}, {"format", r.scene.format}, {"views", r.photographs.views}};
  j["photographs"] = {{"listed", r.scene.listed},
                      {"scaled", r.scene.scaled},
                      {"passed_over", r.scene.passed_over},
                      {"left_out", ordered_json::array()}};
  for (const LeftOutView& v : r.photographs.left_out)
    j["photographs"]["left_out"].push_back(
        {{"name", v.name}, {"reason", to_string(v.reason)}, {"detail", v.detail}});
  j["inputs"] = ordered_json::array();
  for (const InputFile& f : r.scene.inputs)
    j["inputs"].push_back({{"kind", f.kind},
                           {"path", f.path.string()},
                           {"bytes", f.bytes},
                           {"xxh3_128", f.xxh3_128}});
  j["device"] = r.device;
  for (const auto& [name, value] : r.options) j["options"][name] = value;
  j["box"] = {{"min", array_of(r.box.min)}, {"max", array_of(r.box.max)}, {"source", r.box_source}};
  j["image_scale"] = {{"smallest", r.photographs.smallest_scale},
                      {"largest", r.photographs.largest_scale},
                      {"matched", r.photographs.matched_scale}};
}

void add_masks(const Report& r, ordered_json& j) {
  ordered_json& masks = j["masks"];
  masks = {{"source", r.photographs.mask_source},
           {"confidence", r.photographs.mask_confidence},
           {"mended", r.photographs.masks_mended},
           {"offset", r.silhouettes.mask_offset}};
  if (std::isfinite(r.cameras.mask_disagreement))
    masks["disagreement"] = r.cameras.mask_disagreement;
  masks["full_evidence"] = r.full_evidence;
  masks["views"] = ordered_json::array();
  for (const MaskFinding& m : r.photographs.masks)
    masks["views"].push_back(
        {{"name", m.view}, {"source", m.source}, {"confidence", m.confidence}});
  masks["left_out"] = r.silhouettes.masks_left_out;
  for (const OutlineRoom& room : r.silhouettes.outline_room)
    masks["outline_room_pixels"][room.view] = room.pixels;
}

void add_thin_parts(const Report& r, ordered_json& j) {
  const ThinFindings& thin = r.silhouettes.thin;
  j["thin_parts"] = {
      {"line_pixels", thin.line_pixels},         {"looked_at", thin.looked_at},
      {"unexplained", thin.unexplained},         {"placed", thin.placed},
      {"restored_pixels", thin.restored_pixels}, {"stem_vertices", r.mesh.extract.stem_vertices}};
  if (!r.verdict.missing_view.empty())
    j["thin_parts"]["missing_png_shows"] = r.verdict.missing_view;
  if (!thin.worst_view.empty()) j["thin_parts"]["worst_view"] = thin.worst_view;
}

void add_views(const Report& r, ordered_json& j) {
  j["noise_sigma"] = r.photographs.noise_sigma;
  j["grid"] = {{"origin", array_of(r.grid.origin)},
               {"voxel_size", r.grid.voxel_size},
               {"voxels", array_of(r.grid.voxels())},
               {"bricks_stored", r.bricks_stored}};
  if (const FeatureAgreement& f = r.cameras.features; std::isfinite(f.pixels))
    j["feature_agreement"] = {{"pixels", f.pixels}, {"pairs", f.pairs}, {"matches", f.matches}};
  if (!r.cameras.refinement.empty())
    j["camera_refinement"] = ordered_json::parse(r.cameras.refinement);
  if (!r.photometric.json.empty()) j["photometric"] = ordered_json::parse(r.photometric.json);
  j["left_out"] = r.silhouettes.left_out;
  for (const auto& [view, value] : r.silhouettes.sharpness)
    j["sharpness"].push_back({{"name", view}, {"sharpness", value}});
}

void add_sweeps(const SweepFindings& sweep, ordered_json& j) {
  j["photo"] = {{"sweeps", sweep.sweeps},
                {"voxels_judged", sweep.voxels_judged},
                {"voxels_carved", sweep.voxels_carved},
                {"voxels_undecided", sweep.voxels_undecided}};
  if (!sweep.sampling) return;
  j["photo"]["sampler"] = sweep.sampling->sampler;
  j["photo"]["supersample"] = sweep.sampling->supersample;
  j["photo"]["consistency"] = sweep.sampling->consistency;
  j["photo"]["visibility"] = sweep.sampling->visibility;
  j["photo"]["r_consistency"] = sweep.sampling->r_consistency;
}

void add_refinement(const RefineFindings& refine, ordered_json& j) {
  j["resumed_levels"] = refine.resumed_levels;
  j["followed"] = refine.followed;
  if (refine.hull_trust) j["hull_trust"] = *refine.hull_trust;
  j["refine"] = ordered_json::array();
  for (const RefineLevelFindings& level : refine.levels)
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
  for (const RefineFitFindings& fit : refine.fits)
    j["refine_fits"].push_back({{"wall_seconds", fit.wall_seconds},
                                {"held_out_score", fit.held_out},
                                {"held_out_score_fitted", fit.held_out_fitted},
                                {"mean_move_voxels", fit.mean_move},
                                {"kept", fit.kept}});
}

void add_look(const LookFindings& look, ordered_json& j) {
  j["up"] = array_of(look.up);
  j["up_axis"] = array_of(look.up_axis);
  j["preview_png_shows"] = look.main_view;
  j["cameras"] = ordered_json::array();
  for (const CameraPose& pose : look.cameras) {
    const Intrinsics& k = pose.camera.intrinsics;
    const glm::dmat3& r = pose.camera.cam_from_world.rotation;
    ordered_json rows = ordered_json::array();
    for (int row = 0; row < 3; ++row) rows.push_back({r[0][row], r[1][row], r[2][row]});
    j["cameras"].push_back({{"name", pose.name},
                            {"size", {k.width, k.height}},
                            {"focal", {k.fx, k.fy}},
                            {"skew", k.skew},
                            {"principal", {k.cx, k.cy}},
                            {"rotation", rows},
                            {"centre", array_of(pose.camera.center())}});
  }
}

void add_mesh(const Report& r, ordered_json& j) {
  j["voxels_kept"] = r.voxels_kept;
  j["mesh"] = {{"vertices", r.mesh.vertices},
               {"triangles", r.mesh.triangles},
               {"uniform_triangles", r.mesh.uniform_triangles},
               {"sharpened_vertices", r.mesh.extract.sharpened_vertices},
               {"unseen_share", r.mesh.colour.unseen_share},
               {"islands_removed", r.mesh.islands.pieces},
               {"islands_area_share", r.mesh.islands.area_share}};
  if (const auto& error = r.mesh.error)
    j["mesh"]["error_voxels"] = {{"limit", error->limit},
                                 {"mean", error->mean},
                                 {"p95", error->p95},
                                 {"p999", error->p999},
                                 {"max", error->max}};
  if (const auto& t = r.texture)
    j["texture"] = {{"triangles", t->triangles},
                    {"pages", t->pages},
                    {"size", {t->width, t->height}},
                    {"scale", t->scale},
                    {"charts", t->charts},
                    {"views", t->views},
                    {"texels", t->texels},
                    {"filled_share", t->filled_share},
                    {"unseen_share", t->unseen_share},
                    {"memory_bytes", t->bytes}};
  add_look(r.look, j);
  j["surroundings"] = ordered_json::array();
  for (const ShellFindings& shell : r.surroundings)
    j["surroundings"].push_back(
        {{"box", {{"min", array_of(shell.box.min)}, {"max", array_of(shell.box.max)}}},
         {"voxel_size", shell.voxel_size},
         {"voxels", array_of(shell.voxels)},
         {"triangles", shell.triangles},
         {"area_share", shell.area_share}});
}

void add_verdict(const VerdictFindings& verdict, ordered_json& j) {
  if (!verdict.json.empty()) j["verdict"] = ordered_json::parse(verdict.json);
  if (!verdict.explained_view.empty()) j["verdict"]["explained_png_shows"] = verdict.explained_view;
}

void add_stages(const std::vector<StageTime>& stages, ordered_json& j) {
  j["stages"] = ordered_json::array();
  for (const StageTime& s : stages)
    j["stages"].push_back({{"name", s.name},
                           {"wall_seconds", s.wall_seconds},
                           {"cpu_seconds", s.cpu_seconds},
                           {"samples", s.samples},
                           {"peak_memory_bytes", s.peak_memory_bytes}});
}

void add_device_work(const DeviceFindings& work, ordered_json& j) {
  j["device_work"] = {{"uploads", work.uploads},
                      {"bytes_up", work.bytes_up},
                      {"downloads", work.downloads},
                      {"bytes_down", work.bytes_down},
                      {"kernels", ordered_json::array()}};
  for (const KernelFindings& k : work.kernels)
    j["device_work"]["kernels"].push_back({{"name", k.name},
                                           {"launches", k.launches},
                                           {"groups", k.groups},
                                           {"seconds", k.seconds},
                                           {"cpu_seconds", k.cpu_seconds}});
}

}  // namespace

std::string Report::to_json() const {
  ordered_json j;
  add_scene(*this, j);
  add_masks(*this, j);
  add_thin_parts(*this, j);
  add_views(*this, j);
  add_verdict(verdict, j);
  add_stages(stages, j);
  add_device_work(device_work, j);
  j["hull"] = {{"nodes_tested", hull.nodes_tested}, {"bricks_evaluated", hull.bricks_evaluated}};
  add_sweeps(surface.sweep, j);
  add_refinement(surface.refine, j);
  add_mesh(*this, j);
  j["wall_seconds"] = wall_seconds;
  j["cpu_seconds"] = cpu_seconds;
  j["peak_memory_bytes"] = peak_memory_bytes;
  j["warnings"] = warnings;
  j["files"] = files;
  // File names need not be UTF-8, JSON must.
  return j.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace photohull::pipeline
