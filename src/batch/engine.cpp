#include "batch/engine.h"

#include "core/error.h"
#include "core/shell_word.h"

namespace photohull::batch {
namespace {

std::string with_space(const std::string& words) { return words.empty() ? "" : " " + words; }

}  // namespace

std::string to_string(Engine engine) {
  switch (engine) {
    case Engine::kLocal:
      return "local";
    case Engine::kParallel:
      return "parallel";
    case Engine::kMpi:
      return "mpi";
    case Engine::kSlurm:
      return "slurm";
  }
  return {};
}

std::string program_of(Engine engine) {
  switch (engine) {
    case Engine::kLocal:
      return {};
    case Engine::kParallel:
      return "parallel";
    case Engine::kMpi:
      return "mpirun";
    case Engine::kSlurm:
      return "sbatch";
  }
  return {};
}

std::string script_of(const Submission& s) {
  const std::string job = shell_word(s.job.string());
  const std::string run =
      concat(shell_word(s.program.string()), " run ", job, with_space(s.run_options));
  const std::string merge = concat(shell_word(s.program.string()), " merge ", job);
  // A piece that failed is no reason for an engine to stop the other workers.
  const std::string worker = run + " || :";
  const std::string last = concat(run, "; ", merge);
  const std::string options = with_space(s.engine_options);
  const std::string logs = shell_word((s.job / ".photohull-batch").string());
  const std::string start =
      concat("#!/bin/sh\n# ", s.workers, s.workers == 1 ? " worker" : " workers", " by '",
             to_string(s.engine), "'; made by photohull submit.\n");
  switch (s.engine) {
    case Engine::kLocal:
      return concat(start, "for worker in $(seq ", s.workers, "); do\n  ", run, " &\ndone\nwait\n",
                    last, "\n");
    case Engine::kParallel:
      return concat(start, "parallel --will-cite -N0 --jobs ", s.workers, options, " ",
                    shell_word(worker), " ::: $(seq ", s.workers, ")\n", last, "\n");
    case Engine::kMpi:
      return concat(start, "mpirun -n ", s.workers, options, " sh -c ", shell_word(worker), "\n",
                    last, "\n");
    case Engine::kSlurm:
      return concat(start, "set -e\narray=$(sbatch --parsable --job-name=photohull-run --array=1-",
                    s.workers, " --requeue --output=", logs, "/run-%a.log", options, " --wrap ",
                    shell_word(run),
                    ")\nsbatch --job-name=photohull-merge --dependency=afterany:\"${array%%;*}\"",
                    " --output=", logs, "/merge.log", options, " --wrap ", shell_word(last), "\n");
  }
  return {};
}

}  // namespace photohull::batch
