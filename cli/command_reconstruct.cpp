#include <memory>

#include "cli/front/command_table.h"
#include "cli/front/parse_faults.h"
#include "commands.h"
#include "core/error.h"
#include "option_flags.h"
#include "reconstruct_scene.h"
#include "scene_arguments.h"

namespace photohull::cli {
namespace {

struct ReconstructArguments {
  pipeline::ReconstructOptions job;
  io::LoadSceneOptions load;
  std::string scene, out;
  bool json = false;
};

void check(const ReconstructArguments& a) {
  check_scene(a.scene);
  a.job.validate();
  a.load.validate();
  if (a.out.empty()) throw UsageError("--out is empty: give a folder for the results");
}

void run_reconstruct(const ReconstructArguments& a) {
  check(a);
  check_output(a.scene, a.load, a.out);
  reconstruct_scene(a.job, a.load, a.scene, a.out, a.json);
}

void add_options(CLI::App& c, ReconstructArguments& a) {
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
  ReconstructArguments a;
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
  auto a = std::make_shared<ReconstructArguments>();
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
  c->callback([a] { run_reconstruct(*a); });
}

}  // namespace photohull::cli
