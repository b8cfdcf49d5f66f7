// Small scenes and jobs that differ in everything, by number.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pipeline/reconstruct_options.h"
#include "synth/spec.h"

namespace photohull::test {

/// Any built-in shape, material, background, cameras and some degradations; pictures of at most 80
/// pixels. The same number gives the same scene.
synth::Spec random_spec(std::uint64_t number);
/// The same as JSON.
std::string random_spec_text(std::uint64_t number);

/// Any method at 12 to 32 voxels with some of the options.
pipeline::ReconstructOptions random_job(std::uint64_t number);

/// Options of `photohull reconstruct` with values in their ranges; together they may be refused.
std::vector<std::string> random_arguments(std::uint64_t number);

}  // namespace photohull::test
