#include <cstdio>
#include <memory>

#include "batch_arguments.h"
#include "cli/front/command_table.h"
#include "commands.h"
#include "core/shell_word.h"

namespace photohull::cli {
namespace {

void run_plan(const BatchArguments& a) {
  const std::vector<BatchPiece> pieces = a.pieces();
  const batch::Store store(a.out);
  keep_plan(pieces, a, store);
  const std::string job = shell_word(a.out);
  std::printf("%zu %s to make\n", pieces.size(), pieces.size() == 1 ? "scene" : "scenes");
  std::printf("  photohull run %s                  # here\n", job.c_str());
  std::printf("  photohull submit %s --with slurm  # by a cluster\n", job.c_str());
}

}  // namespace

void add_plan(CLI::App& app) {
  auto a = std::make_shared<BatchArguments>();
  CLI::App* c = add_command(app, "plan");
  a->add_to(*c);
  c->footer(
      "Checks the scenes, their options and the folder for results, and writes down there what is "
      "to be made. 'photohull run' makes it, in one process or in many at once; 'photohull submit' "
      "has a cluster do it; 'photohull status' tells how far it is, and 'photohull merge' sums it "
      "up. 'photohull batch' plans and makes at once.\n\n"
      "Examples:\n"
      "  photohull plan --list plants.txt --out /shared/plants\n"
      "  photohull plan rig.json --images \"frames/{frame}\" --frames 0000-0299 --out out/dance\n"
      "  photohull plan statue.json --tiles 64 --out /shared/statue\n"
      "  photohull plan church.json --resolution 12000 --finer 2 --parts 40 --out /shared/church");
  c->callback([a] { run_plan(*a); });
}

}  // namespace photohull::cli
