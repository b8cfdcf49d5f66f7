// The stage that finds which cameras hold.
#pragma once

#include <vector>

#include "pipeline/agree_cameras.h"
#include "pipeline/earlier_results.h"

namespace photohull::pipeline {

/// Those of the rig, where one is given and no refinement is asked for; else agree_cameras, or
/// agree_cameras_once where the job keeps things in a folder. Throws as these and with_cameras_of.
AgreeingCameras find_cameras(const ReconstructOptions& options, const ResultRig* rig,
                             const Scene& scene, std::vector<PreparedView> views,
                             Progress& progress);

}  // namespace photohull::pipeline
