// The first stage: the scene with its box, and how large its photographs are to be read.
#pragma once

#include <optional>
#include <vector>

#include "core/progress.h"
#include "pipeline/findings.h"
#include "pipeline/photographs.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

/// Scales of the scene's views, as the voxels need them.
struct Reading {
  std::vector<double> scales;    ///< (0, 1]
  bool short_of_memory = false;  ///< were they made smaller by --max-memory?
  std::vector<double> matched;   ///< scales that the surface is matched at
  std::int64_t held_bytes = 0;   ///< Plan::held_bytes
};

struct ReadScene {
  Scene scene;              ///< in the photographs' own pixels, views by name, with a box
  bool box_found = false;   ///< not given
  std::optional<Box> seen;  ///< around what the photographs show, where the box was found
  Reading reading;
  SceneFindings findings;
};

/// Throws Error where the box, or the cameras with it, cannot show a shape, or where the job does
/// not fit into memory; UsageError, Cancelled.
ReadScene read_scene(const Photographs& photographs, const ReconstructOptions& options,
                     Progress& progress);

/// For a box in the scene; with a warning where memory makes them smaller. Throws Error where not
/// even that fits.
Reading choose_reading(const Photographs& photographs, const Scene& scene, const Box& box,
                       const ReconstructOptions& options, Progress& progress);

/// The most memory that the job may take, bytes.
std::int64_t memory_limit(const ReconstructOptions& options);

}  // namespace photohull::pipeline
