// Masks that an earlier run made from the background of the same photographs, kept in the output
// folder.
#pragma once

#include <filesystem>

#include "core/progress.h"
#include "views/prepare_views.h"

namespace photohull::pipeline {

/// find_masks, or what it came to in the run before where that looked at the same pixels, with its
/// warnings. What is found is kept in `folder`; `fresh`: found anew. A damaged file is a warning.
/// The finder throws Error where the file cannot be written. `progress` outlives it.
MaskFinder find_masks_once(const std::filesystem::path& folder, bool fresh, Progress& progress);

}  // namespace photohull::pipeline
