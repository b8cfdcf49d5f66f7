// What of the silhouettes a set of voxels covers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "carving/hull.h"
#include "core/grid.h"
#include "gpu/context.h"
#include "projtex/gpu_views.h"
#include "refine/silhouette_cones.h"
#include "visibility/kernels/depth_maps.h"

namespace photohull::refine {

class Coverage {
 public:
  /// Draws `voxels` of the grid, and what is beside them, into every view. What the cones hold
  /// must outlive the object.
  Coverage(gpu::Context& context, const GridSpec& grid, std::span<const glm::ivec3> voxels,
           const SilhouetteCones& cones);

  struct Votes {
    int lack = 0;    ///< views that show foreground, and none of the voxels
    int before = 0;  ///< views in which the point would hide voxels that lie behind it
  };

  /// What the views say of a point (voxel coordinates); foreground counts from `inside` pixels
  /// within the silhouette on.
  Votes votes(const glm::dvec3& point, double inside) const;

  /// The pixels of every view where Votes::lack may count, a byte each; none of a view in which it
  /// nowhere does.
  using LackingPixels = std::vector<std::vector<std::uint8_t>>;
  LackingPixels lacking_pixels(double inside) const;
  /// At least Votes::lack of a point, and most often just that, for a fraction of the time.
  int most_lack(const glm::dvec3& point, const LackingPixels& lacking) const;

 private:
  std::span<const carving::Silhouette> silhouettes_;
  std::vector<projtex::GridCamera> cameras_;
  std::vector<DepthMap> maps_;
};

}  // namespace photohull::refine
