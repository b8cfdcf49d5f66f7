#include <filesystem>
#include <memory>
#include <system_error>

#include "batch_arguments.h"
#include "cli/front/command_table.h"
#include "commands.h"
#include "core/error.h"
#include "gpu/device_options.h"
#include "option_flags.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

struct RunArguments {
  std::string job, pieces, device = "auto";
  int threads = 0;
  bool next = false;
  BatchOptions batch;
};

/// Paths of the plan begin in its folder.
void go_to(const fs::path& folder) {
  std::error_code failure;
  fs::current_path(folder, failure);
  if (failure)
    throw Error(concat(folder.string(), ", where paths of the plan begin: ", failure.message(),
                       "; make the plan anew where the scenes are"));
}

void run_run(RunArguments& a) {
  const batch::Store store = batch::Store::existing(fs::absolute(a.job).lexically_normal());
  const batch::Plan plan = store.plan();
  go_to(plan.folder);
  std::vector<BatchPiece> pieces = planned_pieces(plan, store.folder());
  for (BatchPiece& piece : pieces) {
    if (a.device != "auto") piece.job.device = a.device;
    if (a.threads > 0) piece.job.threads = a.threads;
  }
  a.batch.plan = plan.id;
  a.batch.sequence = plan.sequence;
  a.batch.tiles = plan.tiles;
  a.batch.most = a.next ? 1 : 0;
  a.batch.table = a.pieces.empty() && !a.next;
  if (!a.pieces.empty()) {
    std::vector<BatchPiece> chosen;
    for (const std::size_t i : batch::chosen_pieces(a.pieces, pieces.size()))
      chosen.push_back(std::move(pieces[i]));
    pieces = std::move(chosen);
  }
  run_batch(pieces, store, a.batch);
}

}  // namespace

void add_run(CLI::App& app) {
  auto a = std::make_shared<RunArguments>();
  CLI::App* c = add_command(app, "run");
  add_plan_folder(*c, a->job);
  CLI::Option* pieces = c->add_option(
      "--pieces", a->pieces, "make these alone, counted from 1 in the order of the plan: 3 or 3-7");
  c->add_flag("--next", a->next, "end after one that was free and not made")->excludes(pieces);
  c->add_flag("--retry", a->batch.retry,
              "try again what had no result before, though nothing of it has changed");
  c->add_flag("--json", a->batch.json, "print a line of JSON for each scene instead of a summary");
  Described described;
  gpu::describe_device(described, a->device);
  gpu::describe_threads(described, a->threads);
  add_flags(*c, described);
  c->footer(
      "Makes what 'photohull plan' wrote down and nobody has made. Any number of processes may do "
      "it at once, on one machine or on several that share the folder: each takes scenes that no "
      "other has, and one that is killed loses no more than the scene that it was at. Of a plan "
      "with "
      "tiles, processes that find no scene help those that have one.\n\n"
      "Examples:\n"
      "  photohull run /shared/plants\n"
      "  photohull run /shared/plants --pieces 3-7\n"
      "  srun -n 8 photohull run /shared/plants --threads 4");
  c->callback([a] { run_run(*a); });
}

}  // namespace photohull::cli
