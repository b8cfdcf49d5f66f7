// What of the silhouettes a set of voxels covers.
#pragma once

#include <span>
#include <vector>

#include "carving/hull.h"
#include "core/grid.h"
#include "gpu/context.h"
#include "projtex/gpu_views.h"
#include "visibility/depth_maps.h"

namespace photohull::refine {

class Coverage {
 public:
  /// Draws `voxels` of the grid into every view. The silhouettes, one per camera and parts may be
  /// empty, must outlive the object.
  Coverage(gpu::Context& context, const GridSpec& grid, std::span<const glm::ivec3> voxels,
           std::span<const Camera> cameras, std::span<const carving::Silhouette> silhouettes);

  /// Do at least `least_views` views show foreground, `inside` pixels within the silhouette, at a
  /// point (voxel coordinates), and none of the voxels?
  bool lacks(const glm::dvec3& point, int least_views, double inside) const;

 private:
  bool lacks_in(std::size_t view, const glm::dvec3& point, double inside) const;

  std::span<const carving::Silhouette> silhouettes_;
  std::vector<projtex::GridCamera> cameras_;
  std::vector<shaders::DepthMapInfo> infos_;
  std::vector<std::vector<float>> depths_;
};

}  // namespace photohull::refine
