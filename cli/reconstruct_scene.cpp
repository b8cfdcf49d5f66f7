#include "reconstruct_scene.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/read_file.h"
#include "kept_steps.h"
#include "make_model.h"
#include "pipeline/earlier_results.h"
#include "pipeline/image_scale.h"
#include "pipeline/input_hashes.h"
#include "pipeline/stage_weights.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// Without the end of the line.
void print_sizes(int views, const glm::ivec3& voxels, double voxel_size, std::int64_t triangles) {
  std::printf("%d views, %d x %d x %d voxels of %g, %lld triangles", views, voxels.x, voxels.y,
              voxels.z, voxel_size, static_cast<long long>(triangles));
}

void print_costs(double wall_seconds, double cpu_seconds, std::int64_t bytes) {
  std::printf("%.2f s (%.2f CPU s), peak memory %lld MiB", wall_seconds, cpu_seconds,
              static_cast<long long>(bytes >> 20));
}

void print_summary(const pipeline::Report& report, const std::string& out) {
  print_sizes(report.photographs.views, report.grid.voxels(), report.grid.voxel_size,
              report.mesh.triangles);
  std::printf("\n");
  if (report.photographs.smallest_scale < 1)
    std::printf("photographs read at %s of their size\n",
                pipeline::image_scale_text(report.photographs.smallest_scale).c_str());
  if (report.photographs.matched_scale > report.photographs.smallest_scale)
    std::printf("and the surface matched in them at %s of it\n",
                pipeline::image_scale_text(report.photographs.matched_scale).c_str());
  if (const pipeline::SweepFindings& sweep = report.surface.sweep; sweep.voxels_judged > 0)
    std::printf("judged %lld voxels in %d sweeps, carved %lld\n",
                static_cast<long long>(sweep.voxels_judged), sweep.sweeps,
                static_cast<long long>(sweep.voxels_carved));
  if (!report.photometric.line.empty()) std::printf("%s\n", report.photometric.line.c_str());
  print_costs(report.wall_seconds, report.cpu_seconds, report.peak_memory_bytes);
  std::printf(", on %s\n", report.device.c_str());
  for (const std::string& file : report.files) std::printf("  %s/%s\n", out.c_str(), file.c_str());
  const assess::Verdict& verdict = report.verdict.verdict;
  std::printf("verdict: %s\n", assess::to_string(verdict.level));
  for (const std::string& reason : verdict.reasons) std::printf("  %s\n", reason.c_str());
  for (const std::string& note : verdict.notes) std::printf("  %s\n", note.c_str());
  std::printf("coverage: %s\n", verdict.coverage.c_str());
}

void throw_failed(const std::string& reason) {
  throw Error("the result failed its own checks: " + reason, ErrorKind::kDoubted);
}

json read_report(const fs::path& folder) {
  return json::parse(read_whole_file(folder / "report.json"));
}

/// What print_summary says first, from a report's file.
void print_sizes_and_costs(const json& report) {
  const json& grid = report.at("grid");
  const std::array<int, 3> voxels = grid.at("voxels");
  print_sizes(report.at("scene").at("views"), {voxels[0], voxels[1], voxels[2]},
              grid.at("voxel_size"), report.at("mesh").at("triangles"));
  if (report.contains("parts")) std::printf(", in %zu parts", report["parts"].size());
  std::printf("\n");
  print_costs(report.at("wall_seconds"), report.at("cpu_seconds"), report.at("peak_memory_bytes"));
  std::printf("\n");
}

}  // namespace

void reconstruct_scene(const pipeline::ReconstructOptions& job, const io::LoadSceneOptions& given,
                       const fs::path& scene, const std::string& out, bool json) {
  TerminalProgress progress(pipeline::total_weight(job));
  progress.stage("scene", 0);
  io::LoadSceneOptions load = given;
  load.most_views = io::kEnoughViews;
  const MadeModel made = make_model(job, load, scene, out, progress);
  progress.finish();
  if (!made.report) return tell_results(out, json);
  if (json)
    std::fputs(made.report->to_json().c_str(), stdout);
  else
    print_summary(*made.report, out);
  const assess::Verdict& verdict = made.verdict.verdict;
  if (verdict.level == assess::Level::kFailed) throw_failed(verdict.reasons.front());
}

std::string model_identity(const pipeline::ReconstructOptions& given,
                           const io::LoadSceneOptions& load, const fs::path& scene,
                           const fs::path& out) {
  StepIdentity identity;
  identity.add(fs::absolute(out).lexically_normal().string());
  pipeline::ReconstructOptions job = given;
  job.fresh = false;
  for (const auto& [name, value] : pipeline::named_options(job, load))
    identity.add(name + " " + value);
  for (const pipeline::InputFile& file : pipeline::hash_inputs(io::load_scene(scene, load)))
    identity.add(file.path.string() + " " + file.xxh3_128);
  if (!job.follow.empty()) identity.add(pipeline::digest_of_file(job.follow / "volume.vdb"));
  if (!job.rig_folder().empty())
    identity.add(pipeline::digest_of(pipeline::read_rig(job.rig_folder())));
  return identity.digest();
}

bool has_results(const fs::path& folder) {
  try {
    const json report = read_report(folder);
    std::error_code ignored;
    for (const json& file : report.at("files"))
      if (!fs::is_regular_file(folder / file.get<std::string>(), ignored)) return false;
    return report.at("verdict").at("level").is_string();
  } catch (const json::exception&) {
  } catch (const Error&) {
  }
  return false;
}

void tell_results(const std::string& out, bool as_json) {
  const json report = read_report(out);
  if (as_json) std::fputs(read_whole_file(fs::path(out) / "report.json").c_str(), stdout);
  const auto say = [&](const std::string& line) {
    if (!as_json) std::printf("%s\n", line.c_str());
  };
  if (!as_json) print_sizes_and_costs(report);
  for (const json& file : report.at("files")) say(concat("  ", out, "/", file.get<std::string>()));
  const json& verdict = report.at("verdict");
  const std::string level = verdict.at("level");
  say("verdict: " + level);
  const std::vector<std::string> reasons = verdict.at("reasons");
  for (const std::string& reason : reasons) say("  " + reason);
  for (const json& note : verdict.at("notes")) say("  " + note.get<std::string>());
  say("coverage: " + verdict.at("coverage").get<std::string>());
  if (level == assess::to_string(assess::Level::kFailed))
    throw_failed(reasons.empty() ? "" : reasons.front());
}

}  // namespace photohull::cli
