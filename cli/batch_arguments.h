// Which scenes a batch is of, from the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "batch/pieces.h"
#include "batch/store.h"
#include "batch_job.h"
#include "io/load_scene.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::cli {

/// What `batch` and `plan` have in common.
struct BatchArguments {
  pipeline::ReconstructOptions job;
  io::LoadSceneOptions load;
  std::vector<std::string> scenes;
  std::string list, frames, out;
  int chain = 1, tiles = 0, parts = 0;

  void add_to(CLI::App& command);
  /// One for each scene and frame, their options checked. Throws UsageError and Error.
  std::vector<BatchPiece> pieces() const;
};

/// Adds the argument JOB: the folder of a plan.
void add_plan_folder(CLI::App& command, std::string& job);

/// Keeps in the store what is to be made, for `run`, `status`, `merge` and `submit`.
void keep_plan(const std::vector<BatchPiece>& pieces, const BatchArguments& arguments,
               const batch::Store& store);

/// The pieces of a plan. Their paths are relative to its folder, where the process has to be.
/// Throws as BatchArguments::pieces does.
std::vector<BatchPiece> planned_pieces(const batch::Plan& plan, const std::string& out);

}  // namespace photohull::cli
