// What surrounds the box, on coarser grids.
#pragma once

#include <optional>
#include <vector>

#include "core/box.h"
#include "core/grid.h"
#include "core/mesh.h"
#include "gpu/context.h"
#include "pipeline/hull_stage.h"
#include "pipeline/inputs.h"
#include "pipeline/refine_stage.h"
#include "projtex/image_set.h"

namespace photohull::pipeline {

/// A box around the one before, with larger voxels.
struct Shell {
  Box box;
  GridSpec grid;
};

/// The shells around a box whose voxels are `voxel_size` (world units) large, the innermost first:
/// each with voxels four times as large as before, until `seen` is in them, which holds what the
/// photographs show. Where that is not known there is one, four times as large as the box.
std::vector<Shell> plan_shells(const Box& box, double voxel_size, const std::optional<Box>& seen);

/// What was made.
struct Around {
  TriMesh mesh;  ///< without what the surface in the box has already
  Box box;       ///< that it lies in
};

/// Everything that makes the surroundings, all of which outlives it.
struct SurroundingsJob {
  const ReconstructOptions& options;
  Inputs& inputs;
  gpu::Context& context;
  HullStage& hull;
  RefineStage& refine;
  const projtex::ImageSet& images;
  Report& report;
  Progress& progress;
};

/// The surface around the box, coloured, without what `mesh`, the surface in the box, has already.
/// `open`: without what is unseen and doubtful. Tells the report.
Around make_surroundings(const SurroundingsJob& job, const TriMesh& mesh, bool open);

}  // namespace photohull::pipeline
