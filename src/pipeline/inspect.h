// What a scene holds, before anything is carved.
#pragma once

#include <string>
#include <vector>

#include "core/grid.h"
#include "core/scene.h"

namespace photohull::pipeline {

struct Inspection {
  Scene scene;
  double nearest_angle = 0;  ///< degrees: median angle between a view and its nearest, from the box
  double farthest_angle = 0;      ///< degrees: greatest angle between two views
  double voxel_size = 0;          ///< world: one pixel's footprint at the box's centre, the median
  GridSpec grid;                  ///< of the normal quality
  std::int64_t memory_bytes = 0;  ///< estimate for that grid, images included
  double cpu_seconds = 0;         ///< estimate for the software rasterizer
  std::vector<std::string> warnings;
};

/// Throws Error as reconstruct would for the same scene, without decoding an image.
Inspection inspect(const Scene& scene);

}  // namespace photohull::pipeline
