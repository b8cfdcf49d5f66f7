// Pictures out of a film.
#pragma once

#include <filesystem>
#include <vector>

#include "core/describe.h"
#include "core/progress.h"

namespace photohull::io {

struct FrameOptions {
  int frames = 60;  ///< stretches of equal length that the film is cut into, a picture of each
};

void describe(Described& to, FrameOptions& options);

/// Pictures of each stretch, in the film's order, as JPEG files in `folder`, which is made, by the
/// program ffmpeg: up to six of each, equally far apart, turned as the film says. A film with fewer
/// pictures than stretches gives one a stretch. Throws UsageError for options that are not legal,
/// Error where there is no such film, ffmpeg is not installed or cannot read it, and Cancelled.
std::vector<std::vector<std::filesystem::path>> extract_stretches(
    const std::filesystem::path& film, const std::filesystem::path& folder,
    const FrameOptions& options, const Progress& progress);

}  // namespace photohull::io
