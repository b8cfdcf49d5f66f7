// Photographs out of a film.
#pragma once

#include <filesystem>
#include <vector>

#include "io/film_frames.h"

namespace photohull::cli {

/// The sharpest picture of each stretch of the film, as frame_0001.jpg, ... in the folder, which
/// holds nothing else of an earlier film afterwards. Prints progress. Throws as
/// io::extract_stretches does, and Error where the folder holds what this did not make.
std::vector<std::filesystem::path> take_pictures(const std::filesystem::path& film,
                                                 const std::filesystem::path& folder,
                                                 const io::FrameOptions& options);

}  // namespace photohull::cli
