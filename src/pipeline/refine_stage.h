// The stage that refines the surface (--method refine).
#pragma once

#include <cstdint>

#include "core/grid.h"
#include "gpu/context.h"
#include "mesh/sharpen_edges.h"
#include "pipeline/hull_stage.h"
#include "pipeline/inputs.h"
#include "projtex/image_set.h"
#include "refine/refine.h"

namespace photohull::pipeline {

class RefineStage {
 public:
  /// All outlive it.
  RefineStage(const ReconstructOptions& options, Inputs& inputs, gpu::Context& context,
              Report& report, Progress& progress);

  /// The surface in the scene's box; tells the report. `bounded`: do silhouettes bound it? Levels
  /// that an interrupted run of the same job has done are taken from its checkpoint. Throws Error
  /// where nothing is found.
  SparseVolume run(HullStage& hull, const projtex::ImageSet& images, bool bounded);
  /// The surface in another box, which no silhouettes bound; may be empty.
  SparseVolume run_around(HullStage& hull, const projtex::ImageSet& images, const GridSpec& grid,
                          const Box& box, double nearest_angle);
  void remove_checkpoint() const;

  const SharpenOptions& sharpen() const { return sharpen_; }
  std::int64_t samples() const { return samples_; }

 private:
  void note(const refine::RefineReport& counts);
  std::filesystem::path checkpoint_path() const;

  const ReconstructOptions& options_;
  Inputs& in_;
  gpu::Context& context_;
  Report& report_;
  Progress& progress_;
  refine::RefineOptions refine_;
  SharpenOptions sharpen_;
  std::int64_t samples_ = 0;
};

}  // namespace photohull::pipeline
