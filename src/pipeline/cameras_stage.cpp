#include "pipeline/cameras_stage.h"

#include <utility>

#include "pipeline/camera_cache.h"

namespace photohull::pipeline {

AgreeingCameras find_cameras(const ReconstructOptions& options, const ResultRig* rig,
                             const Scene& scene, std::vector<PreparedView> views,
                             Progress& progress) {
  if (rig && options.takes_rig_cameras())
    return {with_cameras_of(*rig, std::move(views), progress), {}, {}};
  if (options.checkpoint.empty()) return agree_cameras(options, scene, std::move(views), progress);
  return agree_cameras_once(options.checkpoint, options, scene, std::move(views), progress);
}

}  // namespace photohull::pipeline
