#include <memory>

#include "batch_arguments.h"
#include "cli/front/command_table.h"
#include "commands.h"

namespace photohull::cli {
namespace {

struct BatchCommand {
  BatchArguments scenes;
  BatchOptions batch;
};

void run_command(BatchCommand& a) {
  const std::vector<BatchPiece> pieces = a.scenes.pieces();
  a.batch.sequence = !a.scenes.frames.empty();
  a.batch.tiles = a.scenes.tiles;
  const batch::Store store(a.scenes.out);
  keep_plan(pieces, a.scenes, store);
  run_batch(pieces, store, a.batch);
}

}  // namespace

void add_batch(CLI::App& app) {
  auto a = std::make_shared<BatchCommand>();
  CLI::App* c = add_command(app, "batch");
  a->scenes.add_to(*c);
  c->add_flag("--retry", a->batch.retry,
              "try again what had no result before, though nothing of it has changed");
  c->add_flag("--json", a->batch.json, "print a line of JSON for each scene instead of a summary");
  c->footer(
      "Reconstructs scenes one after another; one that fails does not stop the others. batch.csv "
      "in the output folder tells of all of them. Run again, it makes what is not there yet. "
      "Several processes may work at the same batch at once, on one machine or on several that "
      "share the folder: each takes scenes that no other has.\n\n"
      "Examples:\n"
      "  photohull batch plants/*/ --out out/plants --method hull --resolution 256\n"
      "  photohull batch --list plants.txt --out out/plants\n"
      "  photohull batch rig.json --images \"frames/{frame}\" --frames 0000-0299 --out out/dance\n"
      "  photohull batch statue.json --resolution 6000 --parts 8 --out out/statue\n"
      "  srun -n 8 photohull batch --list plants.txt --out /shared/plants");
  c->callback([a] { run_command(*a); });
}

}  // namespace photohull::cli
