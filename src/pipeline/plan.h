// What a job will do, from its options and the scene's cameras alone: voxels, how large photographs
// are read, and what that costs.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/grid.h"
#include "core/scene.h"
#include "pipeline/estimate.h"
#include "pipeline/reconstruct.h"

namespace photohull::pipeline {

/// World size of the voxels: by --resolution, --voxel-size, or as the quality asks from the
/// cameras' pixels. Throws Error and UsageError when the box bears no such voxels.
double voxel_size_of(const ReconstructOptions& options, const Box& box,
                     std::span<const Camera> cameras);

struct Plan {
  std::vector<double> wanted;  ///< of each view: the scale that the voxels need, or as forced
  std::vector<double> scales;  ///< the same, or smaller ones where memory asks for them
  GridSpec grid;               ///< where it was asked for
  Cost cost;
};

/// `scene` is in its files' pixels. `with_grid`: voxels count, else photographs alone. Scales are
/// made smaller until the cost is at most `limit` bytes or nothing more can be done; a forced scale
/// stays. Throws as voxel_size_of and carving::fit_grid do.
Plan plan_job(const ReconstructOptions& options, const Scene& scene, const Box& box, bool with_grid,
              std::int64_t limit);

/// The smallest scale as text: "1/8".
std::string smallest_scale_text(std::span<const double> scales);

}  // namespace photohull::pipeline
