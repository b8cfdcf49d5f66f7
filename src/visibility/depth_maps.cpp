#include "visibility/depth_maps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace photohull::visibility {
namespace {

/// Texels per pixel such that a voxel at the grid's centre covers one texel; never finer than
/// pixels.
double texels_per_pixel(const projtex::GridCamera& camera, const GridSpec& grid) {
  const glm::dvec3 centre = 0.5 * glm::dvec3(grid.voxels() - 1);
  const double depth = (camera.projection * glm::dvec4(centre, 1)).z;
  const double pixels_per_voxel = depth > 1 ? camera.focal / depth : 1.0;
  return std::clamp(1.0 / pixels_per_voxel, 1.0 / 64, 1.0);
}

}  // namespace

DepthMaps::DepthMaps(std::span<const projtex::GridCamera> cameras, const GridSpec& grid)
    : splat_(gpu::Program::compute("visibility_splat_voxels.comp.glsl")) {
  int texels = 0;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const double scale = texels_per_pixel(cameras[i], grid);
    const int width = std::max(1, int(std::ceil(cameras[i].width * scale)));
    const int height = std::max(1, int(std::ceil(cameras[i].height * scale)));
    infos_.push_back({{width, height, texels, int(i)}, {float(scale), 0, 0, 0}});
    texels += width * height;
  }
  info_buffer_ = gpu::Buffer::of(infos_);
  depths_ = gpu::Buffer(std::size_t(texels) * 4);
  clear();
}

void DepthMaps::clear() {
  depths_.fill(std::bit_cast<unsigned>(std::numeric_limits<float>::infinity()));
}

void DepthMaps::bind() const {
  info_buffer_.bind_storage(8);
  depths_.bind_storage(9);
}

void DepthMaps::splat(gpu::Context& context, const gpu::Buffer& voxels, std::size_t count) {
  bind();
  voxels.bind_storage(6);
  splat_.dispatch(context, "visibility_splat_voxels", gpu::group_count(count, 64), infos_.size());
}

std::vector<float> DepthMaps::download(std::size_t map) const {
  const glm::ivec4 size = infos_[map].size;
  return depths_.download<float>(std::size_t(size.x) * size.y, std::size_t(size.z));
}

}  // namespace photohull::visibility
