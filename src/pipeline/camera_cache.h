// Cameras that an earlier run made agree with the same photographs, kept in the output folder.
#pragma once

#include <filesystem>
#include <vector>

#include "core/prepared_view.h"
#include "core/progress.h"
#include "core/scene.h"
#include "pipeline/agree_cameras.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

std::filesystem::path camera_cache_file(const std::filesystem::path& folder);

/// agree_cameras, or what it came to in the run before where that went by the same pixels, masks,
/// cameras and tracks, whatever became of them afterwards (another method, other voxels): its
/// warnings are given again, and a note says so. Cameras that a refinement looked at are kept in
/// `folder`. A damaged file is a warning. Throws Error where it cannot be written, Cancelled.
AgreeingCameras agree_cameras_once(const std::filesystem::path& folder,
                                   const ReconstructOptions& options, const Scene& scene,
                                   std::vector<PreparedView> views, Progress& progress);

}  // namespace photohull::pipeline
