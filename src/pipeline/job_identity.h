// What makes two reconstructions the same job.
#pragma once

#include <string>

#include "pipeline/photographs.h"
#include "pipeline/reconstruct_options.h"
#include "pipeline/subject.h"

namespace photohull::pipeline {

/// 32 hexadecimal digits of the program and its version, the device, the options, the lattice, the
/// cameras and the names, sizes and times of the photographs and masks.
std::string job_identity(const ReconstructOptions& options, const Photographs& photographs,
                         const Subject& subject, const std::string& device);

}  // namespace photohull::pipeline
