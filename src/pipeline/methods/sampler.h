// How the plane sweeps resample photographs.
#pragma once

#include "pipeline/reconstruct_options.h"
#include "projtex/sampler.h"

namespace photohull::pipeline {

projtex::Sampler sampler_of(const ReconstructOptions& options);

}  // namespace photohull::pipeline
