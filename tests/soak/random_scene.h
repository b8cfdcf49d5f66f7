// Small scenes and jobs that differ in everything, by number.
#pragma once

#include <cstdint>
#include <filesystem>

#include "pipeline/reconstruct.h"
#include "synth/spec.h"

namespace photohull::test {

/// Any built-in shape, material, background, cameras and some degradations; pictures of at most 80
/// pixels. The same number gives the same scene.
synth::Spec random_spec(std::uint64_t number);

/// Any method at 12 to 32 voxels with some of the options.
pipeline::ReconstructOptions random_job(std::uint64_t number, const std::filesystem::path& scene,
                                        const std::filesystem::path& output);

}  // namespace photohull::test
