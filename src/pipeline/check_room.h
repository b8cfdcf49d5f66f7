// Whether a job fits into memory, once its box and its silhouettes are known.
#pragma once

#include <cstdint>
#include <span>

#include "core/box.h"
#include "core/camera.h"
#include "core/grid.h"
#include "pipeline/hull.h"
#include "pipeline/reconstruct_options.h"
#include "pipeline/subject.h"

namespace photohull::pipeline {

/// Without silhouettes. Throws Error where the job does not fit.
void check_room(const ReconstructOptions& options, const Box& box, const GridSpec& grid,
                std::span<const Camera> cameras);

/// With silhouettes, where there are any: where little room is left, a coarse hull tells how much
/// surface there is. Returns what Subject::held_bytes may be then. Throws Error where the job does
/// not fit.
std::int64_t check_room(const ReconstructOptions& options, const Subject& subject, Hull& hull);

}  // namespace photohull::pipeline
