// The stage that makes cameras agree with the photographs, where these show that they do not.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/box.h"
#include "core/prepared_view.h"
#include "core/progress.h"
#include "core/scene.h"
#include "pipeline/findings.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

struct AgreeingCameras {
  /// As given, with their cameras and those of their sources refined.
  std::vector<PreparedView> views;
  std::set<std::string> right;  ///< names of views whose features confirm their cameras
  CameraFindings findings;
};

/// By default only where silhouettes tell at once that the cameras disagree. `scene`: that of the
/// views, with the tracks that it lists and a box. Throws Error, Cancelled.
AgreeingCameras agree_cameras(const ReconstructOptions& options, const Scene& scene,
                              std::vector<PreparedView> views, Progress& progress);

}  // namespace photohull::pipeline
