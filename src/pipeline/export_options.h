// What is written of the mesh beside mesh.ply. Private to module pipeline.
#pragma once

#include "core/describe.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

void describe_exports(Described& to, ReconstructOptions& options);

/// Throws UsageError for a format that there is not, and for what none of the files has.
void check_exports(const ReconstructOptions& options);

}  // namespace photohull::pipeline
