#include "refine/coverage.h"

#include <algorithm>
#include <cmath>

#include "gpu/buffer.h"

namespace photohull::refine {
namespace {

constexpr double kBefore = 3;  // voxels between a point and what it would hide
constexpr std::size_t kVoxels = std::size_t(1) << 20;  // drawn at once

}  // namespace

Coverage::Coverage(gpu::Context& context, const GridSpec& grid, std::span<const glm::ivec3> voxels,
                   std::span<const Camera> cameras,
                   std::span<const carving::Silhouette> silhouettes)
    : silhouettes_(silhouettes) {
  for (const Camera& camera : cameras) cameras_.push_back(projtex::to_grid(camera, grid));
  visibility::DepthMaps maps(cameras_, grid);
  std::vector<shaders::GpuView> views;
  for (const auto& camera : cameras_)
    views.push_back(projtex::to_gpu_view(camera, glm::ivec2(camera.width, camera.height)));
  const gpu::Buffer view_buffer = gpu::Buffer::of(views);
  view_buffer.bind_storage(0);
  const std::size_t batch = gpu::batch_size(sizeof(glm::ivec4), kVoxels);
  for (std::size_t first = 0; first < voxels.size(); first += batch) {
    const auto part = voxels.subspan(first, std::min(batch, voxels.size() - first));
    std::vector<glm::ivec4> list{glm::ivec4(int(part.size()), 0, 0, 0)};
    for (const glm::ivec3& voxel : part) list.emplace_back(voxel, 0);
    maps.splat(context, gpu::Buffer::of(list), part.size());
  }
  infos_ = maps.infos();
  for (std::size_t v = 0; v < cameras_.size(); ++v) depths_.push_back(maps.download(v));
}

Coverage::Votes Coverage::votes(const glm::dvec3& point, double inside) const {
  Votes votes;
  for (std::size_t v = 0; v < cameras_.size(); ++v) {
    const SilhouetteDistance* s = silhouettes_[v].distance;
    const glm::dvec3 q = cameras_[v].projection * glm::dvec4(point, 1);
    if (!s || q.z <= 1) continue;
    const double x = q.x / q.z, y = q.y / q.z;
    const int px = int(std::floor(x + 0.5)), py = int(std::floor(y + 0.5));
    if (px < 0 || py < 0 || px >= s->width || py >= s->height) continue;
    const auto& info = infos_[v];
    const int tx = std::clamp(int((x + 0.5) * info.scale.x), 0, info.size.x - 1);
    const int ty = std::clamp(int((y + 0.5) * info.scale.x), 0, info.size.y - 1);
    const float depth = depths_[v][std::size_t(ty) * info.size.x + tx];
    const bool covered = !std::isinf(depth);
    votes.lack += !covered && s->pixels[std::size_t(py) * s->width + px] <= -inside;
    votes.before += covered && q.z + kBefore < depth;
  }
  return votes;
}

}  // namespace photohull::refine
