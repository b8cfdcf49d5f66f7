// What a level of the refinement starts from, and what steps lose and silhouettes prove; private to
// module refine.
#pragma once

#include "core/grid.h"
#include "refine/job.h"
#include "refine/refine.h"

namespace photohull::refine {

/// The volume of the first level: the hull, less space that rays see through; or what they label
/// solid where no silhouettes bound space.
SparseVolume first_guess(const RefineJob& job, const SparseVolume& hull);

/// Changes the volume of a later level to what rays tell that no surface explains.
void revise_by_votes(const RefineJob& job, const SparseVolume& hull, bool last,
                     SparseVolume& volume, LevelReport& counts);

/// Brings back what silhouettes show and the volume does not cover. Not where silhouettes bound
/// nothing: what they show of the surroundings would come back whole.
void restore_lost(const RefineJob& job, const SparseVolume& hull, SparseVolume& volume,
                  LevelReport& counts);

/// Brings back thin parts of the hull, where silhouettes bound space.
void keep_thin(const RefineJob& job, const SparseVolume& hull, SparseVolume& volume,
               LevelReport& counts);

}  // namespace photohull::refine
