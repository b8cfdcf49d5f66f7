// What a job will cost, before anything is decoded.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/box.h"
#include "core/camera.h"
#include "core/grid.h"
#include "pipeline/reconstruct.h"

namespace photohull::pipeline {

struct CostQuestion {
  Box box;
  std::vector<Intrinsics> files;  ///< sizes of the photographs as they are
  std::vector<Camera> cameras;    ///< of the photographs as they are read, in the same order
  std::optional<GridSpec> grid;   ///< nothing: not known yet, photographs alone count
  Method method = Method::kRefine;
  bool masks = true;  ///< there are silhouettes
};

struct Cost {
  std::int64_t bytes = 0;  ///< peak of the process
  double cpu_seconds = 0;  ///< all threads, on the software rasterizer
};

/// Estimates fitted on runs over methods, resolutions, numbers and sizes of photographs, with and
/// without masks (docs/limits.md has the table). How much surface a box holds is not known before:
/// that of the runs is taken, as a share of the box's faces.
Cost estimate_cost(const CostQuestion& question);

}  // namespace photohull::pipeline
