// The surface fitted to the photographs after matching; private to module refine.
#pragma once

#include <cstdint>
#include <vector>

#include "core/grid.h"
#include "core/progress.h"
#include "refine/bounding_hull.h"
#include "refine/job.h"
#include "refine/refine.h"
#include "refine/settle.h"

namespace photohull::refine {

/// Fits the surface to the photographs while the views that were held out gain by it; then once
/// more, which gains on all development scenes, and seats it on the outlines. `settled`: by the
/// level before. Adds a report for each pass, and returns how many texture samples were taken.
std::int64_t fit_passes(const RefineJob& job, const SettledBricks& settled, BoundingHull& bounding,
                        SparseVolume& volume, std::vector<FitReport>& reports, Progress& progress);

}  // namespace photohull::refine
