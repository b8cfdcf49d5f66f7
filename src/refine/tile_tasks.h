// The work of a refinement as tasks that any process can do which has the photographs; private to
// module refine.
#pragma once

#include <string>
#include <vector>

#include "core/grid.h"
#include "refine/fit_patches.h"
#include "refine/job.h"
#include "refine/match_surfels.h"
#include "refine/shared_work.h"
#include "refine/surface.h"

namespace photohull::refine {

/// match_surfels in the job's photographs, by tiles where others may help: the same.
Matches match_in_tiles(const RefineJob& job, const GridSpec& grid, const SurfelsAsked& surfels,
                       const MatchRequest& request);
/// fit_patches in the job's photographs, by tiles where others may help: the same.
std::vector<PatchFit> fit_in_tiles(const RefineJob& job, const MeshSurfels& surfels,
                                   std::span<const ViewChoice> choices);

/// The result of a task of kind kMatch or kFit, whose head was read. Throws Error where it is
/// damaged.
std::string perform_tile(gpu::Context& context, const MatchingPhotographs& photographs,
                         TaskKind kind, ListReader& task);

}  // namespace photohull::refine
