#include <cstdio>
#include <memory>

#include "cli/front/command_table.h"
#include "cli/front/parse_faults.h"
#include "commands.h"
#include "core/error.h"
#include "core/parse_name.h"
#include "option_flags.h"
#include "pipeline/image_scale.h"
#include "pipeline/stage_weights.h"
#include "pipeline/write_results.h"
#include "scene_arguments.h"
#include "terminal_progress.h"

namespace photohull::cli {
namespace {

struct Arguments {
  pipeline::ReconstructOptions job;
  io::LoadSceneOptions load;
  std::string scene, out;
  bool json = false;
};

void check(const Arguments& a) {
  check_scene(a.scene);
  a.job.validate();
  a.load.validate();
  if (a.out.empty()) throw UsageError("--out is empty: give a folder for the results");
}

void print_summary(const pipeline::Report& report, const std::string& out) {
  const glm::ivec3 n = report.grid.voxels();
  std::printf("%d views, %d x %d x %d voxels of %g, %lld triangles\n", report.photographs.views,
              n.x, n.y, n.z, report.grid.voxel_size, static_cast<long long>(report.mesh.triangles));
  if (report.photographs.smallest_scale < 1)
    std::printf("photographs read at %s of their size\n",
                pipeline::image_scale_text(report.photographs.smallest_scale).c_str());
  if (const pipeline::SweepFindings& sweep = report.surface.sweep; sweep.voxels_judged > 0)
    std::printf("judged %lld voxels in %d sweeps, carved %lld\n",
                static_cast<long long>(sweep.voxels_judged), sweep.sweeps,
                static_cast<long long>(sweep.voxels_carved));
  if (!report.photometric.line.empty()) std::printf("%s\n", report.photometric.line.c_str());
  std::printf("%.2f s (%.2f CPU s), peak memory %lld MiB, on %s\n", report.wall_seconds,
              report.cpu_seconds, static_cast<long long>(report.peak_memory_bytes >> 20),
              report.device.c_str());
  for (const std::string& file : report.files) std::printf("  %s/%s\n", out.c_str(), file.c_str());
  const assess::Verdict& verdict = report.verdict.verdict;
  std::printf("verdict: %s\n", assess::to_string(verdict.level));
  for (const std::string& reason : verdict.reasons) std::printf("  %s\n", reason.c_str());
  for (const std::string& note : verdict.notes) std::printf("  %s\n", note.c_str());
  std::printf("coverage: %s\n", verdict.coverage.c_str());
}

/// The files are there all the same, to look at.
void throw_if_failed(const assess::Verdict& verdict) {
  if (verdict.level != assess::Level::kFailed) return;
  throw Error("the result failed its own checks: " + verdict.reasons.front(), ErrorKind::kDoubted);
}

void run(const Arguments& a) {
  check(a);
  check_output(a.scene, a.load, a.out);
  TerminalProgress progress(pipeline::total_weight(a.job));
  progress.stage("scene", 0);
  io::LoadSceneOptions load = a.load;
  load.most_views = io::kEnoughViews;
  const pipeline::Report report = pipeline::reconstruct_to_folder(
      a.job, pipeline::load_photographs(a.scene, load), a.out, progress);
  progress.finish();
  if (a.json)
    std::fputs(report.to_json().c_str(), stdout);
  else
    print_summary(report, a.out);
  throw_if_failed(report.verdict.verdict);
}

void add_options(CLI::App& c, Arguments& a) {
  add_scene(c, a.scene);
  c.add_option("--out", a.out, "folder for the results; made when it does not exist")->required();
  Described job;
  describe(job, a.job, a.load);
  add_flags(c, job);
  c.add_flag("--json", a.json, "print report.json on standard output instead of a summary");
}

}  // namespace

void check_reconstruct(const std::vector<std::string>& arguments) {
  CLI::App command("", "reconstruct");
  Arguments a;
  add_options(command, a);
  std::vector<const char*> words = {"reconstruct", "scene", "--out", "out"};
  for (const std::string& word : arguments) words.push_back(word.c_str());
  try {
    command.parse(int(words.size()), words.data());
  } catch (const CLI::ParseError& e) {
    throw UsageError(parse_fault(command, e));
  }
  check(a);
}

void add_reconstruct(CLI::App& app) {
  auto a = std::make_shared<Arguments>();
  CLI::App* c = add_command(app, "reconstruct");
  add_options(*c, *a);
  c->footer(
      "Writes volume.vdb, mesh.ply, preview.png, report.json and report.html (the page to look "
      "at:\n"
      "'photohull view DIR') into the output folder.\n\n"
      "Examples:\n"
      "  photohull reconstruct datasets/templeSparseRing --out out/temple\n"
      "  photohull reconstruct scan --out out/scan --quality draft\n"
      "  photohull reconstruct scan --out out/scan --resolution 512 --method hull\n"
      "  photohull reconstruct scan --out out/scan --mesh-error 0.25 --unseen open\n"
      "  photohull reconstruct colmap/sparse/0 --out out/plant --box \"-1 -1 0 1 1 2\"\n"
      "  photohull reconstruct transforms.json --out out/x --masks my_masks --views 0-23 --json");
  c->callback([a] { run(*a); });
}

}  // namespace photohull::cli
