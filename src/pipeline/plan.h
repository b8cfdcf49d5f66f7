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
#include "pipeline/photographs.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

/// World size of the voxels: by --resolution, --voxel-size, or as the quality asks from the
/// cameras' pixels, with or without silhouettes. Throws Error and UsageError when the box bears no
/// such voxels.
double voxel_size_of(const ReconstructOptions& options, const Box& box,
                     std::span<const Camera> cameras, bool silhouettes);

/// The voxels that the options ask for. Throws as voxel_size_of and carving::fit_grid do.
GridSpec lattice_of(const ReconstructOptions& options, const Box& box,
                    std::span<const Camera> cameras, bool silhouettes);

/// What is to be done, and with which photographs.
struct Request {
  const ReconstructOptions& options;
  io::MaskSource masks = io::MaskSource::kAuto;
  PhotographReader reader = file_reader();
};

struct Plan {
  std::vector<double> wanted;  ///< of each view: the scale that the voxels need, or as forced
  std::vector<double> scales;  ///< the same, or smaller ones where memory asks for them
  bool silhouettes = true;  ///< may there be any? They are not known before photographs are decoded
  GridSpec grid;            ///< where it was asked for
  Cost cost;
  std::int64_t fixed_bytes = 0;  ///< of the cost, without voxels
  /// For photographs that are matched at the wanted scales, a few at a time (OutOfCorePhotographs),
  /// while all are held at `scales`. 0: they are matched as they are held.
  std::int64_t held_bytes = 0;
};

/// `scene` is in its files' pixels. `with_grid`: voxels count, else photographs alone. Scales are
/// made smaller until the cost is at most `limit` bytes or nothing more can be done; a forced scale
/// stays, and so do those of a part that could be cut smaller. Where the method can match larger
/// photographs than it holds, room is kept for some. Throws as voxel_size_of and carving::fit_grid
/// do.
Plan plan_job(const Request& request, const Scene& scene, const Box& box, bool with_grid,
              std::int64_t limit);

/// What is planned before photographs are decoded. `box_known`: masks do not make the box smaller.
/// Else voxels count in all of the box as long as some scale makes that fit; where none does, what
/// silhouettes leave of the box may still fit: the smallest scales, and the cost of the photographs
/// alone. Throws as plan_job does, but not for a lattice of a box that is not known yet.
Plan plan_reading(const Request& request, const Scene& scene, const Box& box, bool box_known,
                  std::int64_t limit);

/// The smallest scale as text: "1/8".
std::string smallest_scale_text(std::span<const double> scales);

}  // namespace photohull::pipeline
