// The options of a whole and of its parts, made of those of the model that they become.
#pragma once

#include <filesystem>

#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

/// Of the whole: its voxels are doubled `finer` times. Where the options give no size of voxels, it
/// has to be put in before.
ReconstructOptions options_of_whole(ReconstructOptions job, int finer);

/// Of a part of the whole whose results are in the folder. Throws UsageError for options that parts
/// have none of.
ReconstructOptions options_of_part(ReconstructOptions job, const PartNumber& part, int finer,
                                   const std::filesystem::path& whole);

}  // namespace photohull::pipeline
