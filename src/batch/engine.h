// Programs that run the processes of a batch: a script for each.
#pragma once

#include <array>
#include <filesystem>
#include <string>

namespace photohull::batch {

enum class Engine { kLocal, kParallel, kMpi, kSlurm };
inline constexpr std::array kEngines = {Engine::kLocal, Engine::kParallel, Engine::kMpi,
                                        Engine::kSlurm};
std::string to_string(Engine engine);  ///< "local", "parallel", "mpi", "slurm"
/// The program that has to be installed; empty: none.
std::string program_of(Engine engine);

/// How a batch is run.
struct Submission {
  Engine engine = Engine::kLocal;
  std::filesystem::path program, job;  ///< this program and the batch's folder, absolute
  int workers = 1;                     ///< processes
  std::string run_options;             ///< words of `run`, such as "--threads 2", for a shell
  std::string engine_options;          ///< words of the engine, for a shell
};

/// A script for the shell `sh`. It starts the workers, each of which makes pieces until none is
/// free, and when they have ended, however they did, one more that makes what is left and tells
/// what became of all. It ends as that one ends; where the engine has a queue, as soon as both are
/// in it.
std::string script_of(const Submission& submission);

}  // namespace photohull::batch
