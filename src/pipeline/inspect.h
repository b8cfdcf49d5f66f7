// What a scene holds, before anything is carved.
#pragma once

#include <exception>
#include <optional>
#include <string>
#include <vector>

#include "core/grid.h"
#include "core/scene.h"
#include "pipeline/extents.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

struct Inspection {
  Scene scene;
  Extents extents;
  /// Why reconstruct would refuse, an Error; null: it would not. What follows is then known in
  /// part.
  std::exception_ptr failure;
  std::optional<Box> suggested_box;  ///< where there is none, or a failure
  double nearest_angle = 0;  ///< degrees: median angle between a view and its nearest, from the box
  double farthest_angle = 0;      ///< degrees: greatest angle between two views
  double voxel_size = 0;          ///< world: one pixel's footprint at the box's centre, the median
  bool silhouettes = true;        ///< may there be any? Not with --masks none
  GridSpec grid;                  ///< as the options ask for it
  std::vector<double> scales;     ///< at which photographs would be read; empty: not known
  std::vector<double> matched;    ///< and matched, larger where only some fit into memory
  std::int64_t memory_bytes = 0;  ///< estimate of the job's peak
  std::int64_t memory_limit = 0;  ///< what it may take; more is refused
  double cpu_seconds = 0;         ///< estimate for the software rasterizer
  std::vector<std::string> warnings;
};

/// Of what a job with these options would do, without decoding
/// an image. What reconstruct would refuse the scene for is the result's failure, but not want of
/// memory. Throws UsageError for options that do not suit the scene.
Inspection inspect(const Scene& scene, const ReconstructOptions& options,
                   io::MaskSource masks = io::MaskSource::kAuto);

}  // namespace photohull::pipeline
