// The stage that carves by plane sweeps (--method voxel-coloring and space-carving).
#pragma once

#include <cstdint>

#include "core/grid.h"
#include "gpu/context.h"
#include "pipeline/inputs.h"
#include "projtex/image_set.h"

namespace photohull::pipeline {

/// How the sweeps resample photographs.
projtex::Sampler sampler_of(const ReconstructOptions& options);

/// What photo-consistency leaves of the hull; tells the report. `samples`: texture samples taken.
/// Throws Error where that is nothing.
SparseVolume sweep_hull(const ReconstructOptions& options, const SparseVolume& hull,
                        const projtex::ImageSet& images, Inputs& inputs, gpu::Context& context,
                        Report& report, Progress& progress, std::int64_t& samples);

}  // namespace photohull::pipeline
