// Depth maps of voxels from the input cameras [Williams78].
#pragma once

#include <span>
#include <vector>

#include "core/depth_map.h"
#include "core/grid.h"
#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/texture.h"
#include "projtex/gpu_views.h"
#include "shared/depth_map.h"

namespace photohull::visibility {

/// One depth map per camera, with texels about as large as a voxel looks from there.
class DepthMaps {
 public:
  /// Maps for `cameras` (in the grid's frame) that look at `grid`. Nothing hides anything yet.
  /// `cut_at`: pixels at whose multiples the photographs may have been cut; a texel begins at each
  /// of them, so that texels are the same wherever that was. 1: they were not.
  /// Throws Error when the device cannot hold them.
  DepthMaps(std::span<const projtex::GridCamera> cameras, const GridSpec& grid, int cut_at = 1);

  /// Forgets all that was drawn.
  void clear();
  /// Draws what maps of the same cameras hold, whatever their texels; `unit` is that of their
  /// depths, in voxels. Nothing else has been drawn.
  void draw(std::span<const DepthMap> maps, double unit);
  /// Binds what include/depth_map.glsl reads and writes.
  void bind() const;
  /// What programs that use the maps are compiled with: where the depths are.
  const char* defines() const { return layers_.id() ? "#define DEPTH_MAPS_LAYERED\n" : ""; }
  /// Draws the first `count` voxels of `voxels` (ivec4, preceded by a header of 16 bytes whose
  /// first word is the count) into all maps. Cameras must be bound: to kViewsBinding, or as the
  /// programs that `view_defines` makes read them (projtex::DeviceViews).
  void splat(gpu::Context& context, const gpu::Buffer& voxels, std::size_t count,
             const char* view_defines = "");

  /// Draws voxels into all maps; `cameras` are those that the maps were made for.
  void draw(gpu::Context& context, std::span<const projtex::GridCamera> cameras,
            std::span<const glm::ivec3> voxels);
  DepthMap map(std::size_t index) const;  ///< depths in voxels

  const std::vector<shaders::DepthMapInfo>& infos() const { return infos_; }
  /// Depths in voxels of one map, row-major; +infinity where nothing was drawn.
  std::vector<float> download(std::size_t map) const;

 private:
  std::vector<shaders::DepthMapInfo> infos_;
  gpu::Buffer info_buffer_, depths_;
  gpu::TextureArray layers_;  ///< in place of depths_, where a storage block is too small
};

namespace reference {

/// Draws a voxel into a map of `info` (row-major depths), as DepthMaps::splat does; double
/// precision.
void splat_voxel(const projtex::GridCamera& camera, const shaders::DepthMapInfo& info,
                 const glm::ivec3& voxel, std::vector<double>& depths);

/// Is a point (voxel coordinates) not hidden in the map, with a constant bias in voxels?
bool visible(const projtex::GridCamera& camera, const shaders::DepthMapInfo& info,
             const glm::dvec3& point, double bias, std::span<const double> depths);

}  // namespace reference
}  // namespace photohull::visibility
