// The project's own photographs, reconstructed.
#pragma once

#include <cmath>
#include <optional>

#include "pipeline/reconstruct.h"
#include "support/places.h"

namespace photohull::pipeline {

/// Cubic world units.
inline double solid(const Reconstruction& result) {
  return double(result.report.voxels_kept) * std::pow(result.report.grid.voxel_size, 3);
}

inline Reconstruction reconstruct_temple(int resolution, Method method,
                                         std::optional<Box> box = std::nullopt) {
  ReconstructOptions options;
  options.resolution = resolution;
  options.method = method;
  io::LoadSceneOptions load;
  load.box = box;
  options.device = "software";
  options.refine_cameras = RefineCameras::kOff;  // what the cameras as they are lead to
  Progress silent;
  return Reconstructor(options).run(
      load_photographs(test::in_checkout("datasets/templeSparseRing"), load), silent);
}

}  // namespace photohull::pipeline
