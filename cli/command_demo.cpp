#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "cli/front/command_table.h"
#include "cli/front/programs.h"
#include "commands.h"
#include "core/error.h"
#include "option_flags.h"
#include "reconstruct_scene.h"
#include "scene_arguments.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPhotographs = "templeSparseRing";

struct DemoArguments {
  pipeline::ReconstructOptions job;
  io::LoadSceneOptions load;
  std::string out = "temple";
};

/// The photographs of the temple: those installed with the program, or those of the checkout that
/// it was built in, as build/NAME/photohull.
fs::path find_photographs() {
  const fs::path installed = program_beside("../share/photohull"), checkout = "../../datasets";
  for (const fs::path& folder : {installed, program_beside(checkout.string())}) {
    std::error_code error;
    const fs::path found = (folder / kPhotographs).lexically_normal();
    if (fs::is_directory(found, error)) return found;
  }
  throw Error(concat((installed / kPhotographs).lexically_normal().string(),
                     ": the photographs of the demo are not there; they are installed with the "
                     "program, and lie in datasets/ of its sources"));
}

void run_demo(const DemoArguments& a) {
  a.job.validate();
  if (a.out.empty()) throw UsageError("--out is empty: give a folder for the results");
  const fs::path photographs = find_photographs();
  std::printf("photohull reconstruct %s --out %s\n", photographs.c_str(), a.out.c_str());
  std::fflush(stdout);
  check_output(photographs, a.load, a.out);
  reconstruct_scene(a.job, a.load, photographs, a.out, false);
}

}  // namespace

void add_demo(CLI::App& app) {
  auto a = std::make_shared<DemoArguments>();
  CLI::App* c = add_command(app, "demo");
  c->add_option("--out", a->out, "folder for the results; made when it does not exist [temple]");
  Described job;
  describe(job, a->job, a->load);
  add_flags(*c, job, {"device", "resolution"});
  c->footer(
      "Reconstructs a plaster temple from 16 photographs that come with the program, by the "
      "command "
      "that\nit prints. It shows in half a minute whether photohull works on this machine.\n\n"
      "Examples:\n"
      "  photohull demo\n"
      "  photohull demo --out /tmp/temple    # then: photohull view /tmp/temple");
  c->callback([a] { run_demo(*a); });
}

}  // namespace photohull::cli
