// What a scene holds, before anything is carved.
#pragma once

#include <string>
#include <vector>

#include "core/grid.h"
#include "core/scene.h"
#include "pipeline/reconstruct.h"

namespace photohull::pipeline {

struct Inspection {
  Scene scene;
  double nearest_angle = 0;  ///< degrees: median angle between a view and its nearest, from the box
  double farthest_angle = 0;      ///< degrees: greatest angle between two views
  double voxel_size = 0;          ///< world: one pixel's footprint at the box's centre, the median
  GridSpec grid;                  ///< as the options ask for it
  std::vector<double> scales;     ///< at which photographs would be read
  std::int64_t memory_bytes = 0;  ///< estimate of the job's peak
  std::int64_t memory_limit = 0;  ///< what it may take; more is refused
  double cpu_seconds = 0;         ///< estimate for the software rasterizer
  std::vector<std::string> warnings;
};

/// Of what a job with these options (`scene` and `output` do not count) would do. Throws Error as
/// reconstruct would for the same scene, without decoding an image, but not for want of memory.
Inspection inspect(const Scene& scene, const ReconstructOptions& options);

}  // namespace photohull::pipeline
