// The first half of the main job: from photographs to what is carved. Private to Reconstructor.
#pragma once

#include <memory>

#include "gpu/context.h"
#include "pipeline/earlier_results.h"
#include "pipeline/reconstruct.h"
#include "pipeline/stage_clock.h"
#include "pipeline/subject.h"

namespace photohull::pipeline {

/// One run. Each stage gets values and returns values; the report takes what it found out and is
/// read by none of them.
struct Run {
  const ReconstructOptions& options;
  const Photographs& photographs;
  Progress& progress;
  const TakeVolume& take_volume;
  StageClock clock{progress};
  Report report{};
  std::unique_ptr<gpu::Context> context{};
  EarlierResults earlier{};
};

/// What the photographs show, up to silhouettes.
struct Prepared {
  Subject subject;
  bool masks = false;  ///< were there any, before some were left out?
  CameraFindings cameras;
  SilhouetteFindings silhouettes;
};

/// Reads and prepares the photographs, and opens the device. Throws Error, Cancelled.
Prepared prepare(Run& run);

/// The options as they hold for a part, if one is made: it has the voxels and the box that it was
/// cut out with.
ReconstructOptions options_of(const std::optional<Part>& part, ReconstructOptions options);
/// The photographs with the box of the whole that a part is made of.
Photographs photographs_of(const Part& part, Photographs photographs);

}  // namespace photohull::pipeline
