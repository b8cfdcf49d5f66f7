// The surface moved to where the photographs agree; private to module refine.
#pragma once

#include "core/grid.h"
#include "refine/job.h"
#include "refine/refine.h"
#include "refine/settle.h"

namespace photohull::refine {

/// Where in the refinement a step is.
struct StepPlace {
  bool first_level = false;
  bool last = false;  ///< of all steps
};

/// What a step leaves beside the volume.
struct StepFindings {
  SettledBricks settled;  ///< of this level's surface
  Proof proof;            ///< of the last step, where silhouettes bound space
};

/// Matches patches at the volume's surface along their normals, and moves the signed distance to
/// where they agree best; frees what views see through. `settled`: by the level before. Fills what
/// of the counts concerns a step.
StepFindings matching_step(const RefineJob& job, const SettledBricks& settled,
                           const SparseVolume& hull, const StepPlace& place, SparseVolume& volume,
                           LevelReport& counts);

}  // namespace photohull::refine
