// What a finished level leaves to the next, on disk, so that an interrupted job can go on.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/grid.h"
#include "core/progress.h"
#include "refine/refine.h"
#include "refine/settle.h"

namespace photohull::refine {

struct Checkpoint {
  SparseVolume volume;  ///< on the grid of the last level that is done
  SettledBricks settled;
  std::vector<LevelReport> levels;  ///< of the levels that are done
};

/// Writes the file whole or not at all. Throws Error when that fails.
void write_checkpoint(const CheckpointFile& file, const Checkpoint& checkpoint);

/// What the file holds, if it exists, was written by the same job, and belongs to one of `grids`
/// but the last. A file that is damaged is a warning.
std::optional<Checkpoint> read_checkpoint(const CheckpointFile& file,
                                          std::span<const GridSpec> grids, Progress& progress);

}  // namespace photohull::refine
