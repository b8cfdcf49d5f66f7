// What a job will cost, before anything is decoded.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/camera.h"
#include "core/grid.h"
#include "pipeline/reconstruct_options.h"

namespace photohull::pipeline {

/// Where the silhouettes come from.
enum class Silhouettes { kGiven, kMade, kNone };

/// Of a part, whose surface is known, and which knows depths of what lies beside it.
struct PartCost {
  double pixels = 0;  ///< of the photographs before they are cut to it; 0: they are cut
  double bricks = 0;  ///< that hold its surface
};

struct CostQuestion {
  std::vector<Intrinsics> files;  ///< sizes of the photographs as they are
  std::vector<Camera> cameras;    ///< of the photographs as they are read, in the same order
  std::optional<GridSpec> grid;   ///< nothing: not known yet, photographs alone count
  Method method = Method::kRefine;
  Silhouettes masks = Silhouettes::kGiven;
  std::optional<PartCost> part;    ///< nothing: it is none
  std::int64_t texture_bytes = 0;  ///< that making a texture may take (texture_stage.h); 0: no such
  double pixel = 0;  ///< of the photographs as read, world units at the box's centre; for a texture
  /// Area of the hull, squares of voxels, where masks were seen; nothing: not known yet.
  std::optional<double> hull_area;
};

struct Cost {
  std::int64_t bytes = 0;  ///< peak of the process
  double cpu_seconds = 0;  ///< all threads, on the software rasterizer
};

/// Estimates fitted on runs over methods, resolutions, numbers and sizes of photographs, with and
/// without masks (docs/guide/limits.md has the table). How much surface a box holds is not known
/// before masks are seen: a usual share of the box's faces is taken.
Cost estimate_cost(const CostQuestion& question);

}  // namespace photohull::pipeline
