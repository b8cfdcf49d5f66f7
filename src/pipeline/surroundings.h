// What surrounds the box, on coarser grids.
#pragma once

#include <optional>
#include <vector>

#include "core/box.h"
#include "core/grid.h"
#include "core/mesh.h"
#include "pipeline/findings.h"
#include "pipeline/methods/method.h"

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
  TriMesh mesh;                         ///< without what the surface in the box has already
  Box box;                              ///< that it lies in
  std::vector<ShellFindings> findings;  ///< the innermost first
  std::int64_t samples = 0;             ///< of textures
};

/// The surface around the box, coloured, without what `mesh`, the surface in the box, has already.
/// `open`: without what is unseen and doubtful. The method carves around the box.
Around make_surroundings(const SurfaceJob& job, const TriMesh& mesh, bool open);

/// Where they are asked for and silhouettes bound the object.
void warn_of_surroundings(const ReconstructOptions& options, bool bounded, Progress& progress);

}  // namespace photohull::pipeline
