#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "batch/engine.h"
#include "batch_arguments.h"
#include "cli/front/command_table.h"
#include "cli/front/programs.h"
#include "commands.h"
#include "core/atomic_file.h"
#include "core/child_process.h"
#include "core/describe.h"
#include "core/error.h"
#include "option_flags.h"

namespace photohull::cli {
namespace {

namespace fs = std::filesystem;

struct SubmitArguments {
  std::string job, engine_options;
  batch::Engine engine = batch::Engine::kLocal;
  int workers = 0, threads = 0;
  bool dry_run = false;
};

void describe(Described& to, SubmitArguments& a) {
  to.choice("with", &a.engine, batch::kEngines,
            "what starts the processes: this machine, GNU parallel, MPI's mpirun, or Slurm");
  to.number("workers", &a.workers, from_to(0, 10000), "", "processes").zero =
      "one, or with a cluster one for each scene or each four tiles of one, at most 64";
  to.number("threads", &a.threads, from_to(0, 1024), "", "processor threads of each process").zero =
      "all cores";
  to.text("engine_options", &a.engine_options,
          "words for the engine, such as '--partition=short --time=60'");
}

int workers_of(const SubmitArguments& a, const batch::Plan& plan) {
  constexpr std::size_t kMost = 64, kTiles = 4;  // tiles a worker, so that none waits for long
  if (a.workers > 0) return a.workers;
  const std::size_t each = std::max<std::size_t>(1, std::size_t(plan.tiles) / kTiles);
  return a.engine == batch::Engine::kLocal ? 1 : int(std::min(plan.pieces.size() * each, kMost));
}

void run_submit(const SubmitArguments& a) {
  const batch::Store store = batch::Store::existing(fs::absolute(a.job).lexically_normal());
  const std::string needed = batch::program_of(a.engine);
  if (!a.dry_run && !needed.empty() && !is_on_path(needed))
    throw Error(concat("--with ", to_string(a.engine), " needs the program '", needed,
                       "', which is not on the PATH; install it, or choose another by --with"));
  const std::string script = batch::script_of(
      {a.engine, program_beside("photohull"), store.folder(), workers_of(a, store.plan()),
       a.threads > 0 ? concat("--threads ", a.threads) : "", a.engine_options});
  if (a.dry_run) {
    std::fputs(script.c_str(), stdout);
    return;
  }
  const fs::path file = store.folder() / "submit.sh";
  write_atomically(file, script);
  ::execl("/bin/sh", "sh", file.c_str(), nullptr);
  throw Error(concat("/bin/sh: ", std::strerror(errno)));
}

}  // namespace

void add_submit(CLI::App& app) {
  auto a = std::make_shared<SubmitArguments>();
  CLI::App* c = add_command(app, "submit");
  add_plan_folder(*c, a->job);
  add_flags_of(*c, *a);
  c->add_flag("--dry-run", a->dry_run, "print the script instead of running it");
  c->footer(
      "Has an engine run processes that make a plan: writes a script, submit.sh in the plan's "
      "folder, and runs it. When all processes have ended, one more makes what a killed one left, "
      "and sums up. Submitted again, it makes what is not there yet.\n\n"
      "Examples:\n"
      "  photohull submit out/plants --workers 4 --threads 2\n"
      "  photohull submit /shared/plants --with slurm --workers 20 --engine-options "
      "\"--cpus-per-task=8 --mem=16G\"\n"
      "  photohull submit /shared/plants --with parallel --engine-options \"--sshlogin a,b\"\n"
      "  photohull submit /shared/plants --with mpi --workers 8 --dry-run");
  c->callback([a] { run_submit(*a); });
}

}  // namespace photohull::cli
