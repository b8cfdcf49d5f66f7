// Who sees what, exactly.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/grid.h"
#include "raycast/ray_scene.h"
#include "visibility/kernels/visibility_map.h"

namespace photohull::visibility {

/// 1 for each sample that the viewpoint has on its image with nothing of the mesh between, by rays.
/// What lies within 3e-6 of the distance before a sample, or is its own triangle, does not hide it.
std::vector<std::uint8_t> visible_by_rays(const RayScene& mesh, const Camera& viewpoint,
                                          std::span<const Sample> samples);

/// Rays through the voxels of negative distance, in double precision [AmanatidesWoo87].
class VoxelRays {
 public:
  explicit VoxelRays(const SparseVolume& volume);

  /// Length, in lengths of `direction`, at which a ray enters the first voxel, 0 where it starts in
  /// one; nothing when there is none before `end`. World coordinates.
  std::optional<double> first(const glm::dvec3& origin, const glm::dvec3& direction,
                              double end) const;

 private:
  bool inside(const glm::ivec3& voxel) const;
  GridSpec grid_;
  std::vector<std::uint32_t> table_, words_;
};

/// The same for volumes: what lies within `slack` voxels before a sample does not hide it.
std::vector<std::uint8_t> visible_by_rays(const VoxelRays& volume, const GridSpec& grid,
                                          const Camera& viewpoint, std::span<const Sample> samples,
                                          double slack);

}  // namespace photohull::visibility
