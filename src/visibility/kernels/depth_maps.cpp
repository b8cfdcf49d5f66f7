#include "visibility/kernels/depth_maps.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "core/error.h"
#include "gpu/program.h"
#include "projtex/device_views.h"

namespace photohull::visibility {
namespace {

constexpr std::size_t kVoxels = std::size_t(1) << 20;  // drawn at once

/// Texels per pixel such that a voxel at the grid's centre covers one texel; never finer than
/// pixels. Fewer where `cut_at` pixels would not be a whole number of texels.
double texels_per_pixel(const projtex::GridCamera& camera, const GridSpec& grid, int cut_at) {
  const double depth = projtex::viewing_depth(camera, grid);
  const double pixels_per_voxel = depth > 1 ? camera.focal / depth : 1.0;
  const double scale = std::clamp(1.0 / pixels_per_voxel, 1.0 / 64, 1.0);
  return cut_at > 1 ? std::max(std::floor(scale * cut_at), 1.0) / cut_at : scale;
}

}  // namespace

DepthMaps::DepthMaps(std::span<const projtex::GridCamera> cameras, const GridSpec& grid,
                     int cut_at) {
  std::size_t texels = 0;
  glm::ivec2 largest(1);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const double scale = texels_per_pixel(cameras[i], grid, cut_at);
    const int width = std::max(1, int(std::ceil(cameras[i].width * scale)));
    const int height = std::max(1, int(std::ceil(cameras[i].height * scale)));
    infos_.push_back({{width, height, int(texels), int(i)}, {float(scale), 0, 0, 0}});
    texels += std::size_t(width) * height;
    largest = glm::max(largest, {width, height});
  }
  if (texels * 4 <= std::size_t(gpu::current_limits().ssbo_bytes)) {
    depths_ = gpu::Buffer(texels * 4);
  } else {
    layers_ =
        gpu::TextureArray(gpu::TextureFormat::kR32ui, largest.x, largest.y, int(cameras.size()));
    for (auto& info : infos_) info.size.z = info.size.w;
  }
  info_buffer_ = gpu::Buffer::of(infos_);
  clear();
}

void DepthMaps::clear() {
  const auto nothing = std::bit_cast<unsigned>(std::numeric_limits<float>::infinity());
  if (layers_.id())
    layers_.fill(nothing);
  else
    depths_.fill(nothing);
}

void DepthMaps::draw(std::span<const DepthMap> maps, double unit) {
  PHOTOHULL_CHECK_OP(maps.size(), ==, infos_.size());
  for (std::size_t v = 0; v < maps.size(); ++v) {
    const glm::ivec4 size = infos_[v].size;
    std::vector<float> depths;
    depths.reserve(std::size_t(size.x) * std::size_t(size.y));
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) {
        const glm::dvec2 pixel = (glm::dvec2(x, y) + 0.5) / double(infos_[v].scale.x) - 0.5;
        depths.push_back(float(double(maps[v].at(pixel)) * unit));
      }
    if (layers_.id())
      layers_.upload(size.z, size.x, size.y, depths.data());
    else
      depths_.write(std::size_t(size.z) * sizeof(float), depths.size() * sizeof(float),
                    depths.data());
  }
}

void DepthMaps::bind() const {
  info_buffer_.bind_storage(shaders::kDepthMapInfosBinding);
  if (layers_.id())
    layers_.bind_read_write(shaders::kDepthMapLayersUnit);
  else
    depths_.bind_storage(shaders::kDepthMapsBinding);
}

void DepthMaps::splat(gpu::Context& context, const gpu::Buffer& voxels, std::size_t count,
                      const char* view_defines) {
  bind();
  voxels.bind_storage(shaders::kOccludersBinding);
  gpu::Program::compute(context, "visibility_splat_voxels.comp.glsl",
                        concat(defines(), view_defines))
      ->dispatch(context, "visibility_splat_voxels",
                 gpu::group_count(count, shaders::kSplatGroup * shaders::kSplatRun), infos_.size());
}

void DepthMaps::draw(gpu::Context& context, std::span<const projtex::GridCamera> cameras,
                     std::span<const glm::ivec3> voxels) {
  std::vector<shaders::GpuView> views;
  for (const auto& camera : cameras)
    views.push_back(projtex::to_gpu_view(camera, glm::ivec2(camera.width, camera.height)));
  const projtex::DeviceViews device_views(std::move(views));
  device_views.bind();
  const std::size_t batch = gpu::batch_size(sizeof(glm::ivec4), kVoxels);
  for (std::size_t first = 0; first < voxels.size(); first += batch) {
    const auto part = voxels.subspan(first, std::min(batch, voxels.size() - first));
    std::vector<glm::ivec4> list{glm::ivec4(int(part.size()), 0, 0, 0)};
    for (const glm::ivec3& voxel : part) list.emplace_back(voxel, 0);
    splat(context, gpu::Buffer::of(list), part.size(), device_views.defines());
  }
}

DepthMap DepthMaps::map(std::size_t index) const {
  const shaders::DepthMapInfo& info = infos_[index];
  return {glm::ivec2(info.size), info.scale.x, download(index)};
}

std::vector<float> DepthMaps::download(std::size_t map) const {
  const glm::ivec4 size = infos_[map].size;
  const std::size_t texels = std::size_t(size.x) * size.y;
  if (!layers_.id()) return depths_.download<float>(texels, std::size_t(size.z));
  std::vector<float> out(texels);  // the same bits
  layers_.read_layer(size.z, size.x, size.y, texels * 4, out.data());
  return out;
}

}  // namespace photohull::visibility
