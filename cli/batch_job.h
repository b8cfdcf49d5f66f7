// The reconstructions of a batch, done by one process among those that may work at it.
#pragma once

#include <string>
#include <vector>

#include "batch/store.h"
#include "io/load_scene.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::cli {

struct BatchPiece {
  std::string name, scene;
  pipeline::ReconstructOptions job;
  io::LoadSceneOptions load;
  std::vector<std::string> joins{};  ///< as batch::Piece has them
};

struct BatchOptions {
  bool json = false;      ///< a line of JSON on standard output for each piece
  bool retry = false;     ///< make anew what had no result before, though nothing has changed
  bool sequence = false;  ///< volumes by the names that sequences have: volume.0007.vdb
  int tiles =
      0;         ///< that a piece's surface is cut into, for processes without one to help; 0: none
  int most = 0;  ///< end after so many that were free and not made; 0: go through all
  /// Id of the plan: what was made by it is kept without a look at its photographs. Empty: all are
  /// looked at.
  std::string plan;
  bool table = true;  ///< write the table, for these are all pieces of the batch
};

/// Makes every piece that is neither made nor in other hands; comes back once to those that were,
/// for their process may have been killed. Then makes the table. A piece that fails does not keep
/// the others from being made. Throws Error when all have been gone through and
/// some have no result, of the kind kDoubted when some only failed their own checks; Cancelled.
void run_batch(const std::vector<BatchPiece>& pieces, const batch::Store& store,
               const BatchOptions& options);

}  // namespace photohull::cli
