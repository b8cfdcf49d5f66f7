// The stage that decodes photographs: views, undistorted, with masks that have been looked at.
#pragma once

#include <cstdint>
#include <vector>

#include "core/prepared_view.h"
#include "core/progress.h"
#include "pipeline/findings.h"
#include "pipeline/photographs.h"
#include "pipeline/read_scene.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

struct PreparedScene {
  Scene scene;                      ///< at the scale that its photographs were read at
  std::vector<PreparedView> views;  ///< one for each of the scene's
  ViewFindings findings;
  std::int64_t held_bytes = 0;  ///< Plan::held_bytes
};

/// Reads the photographs as large as the voxels need them. Throws Error, UsageError, Cancelled.
PreparedScene prepare_scene(const Photographs& photographs, ReadScene read,
                            const ReconstructOptions& options, Progress& progress);

}  // namespace photohull::pipeline
