#include "refine/restore.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gpu/buffer.h"
#include "visibility/depth_maps.h"
#include "volume/combine.h"

namespace photohull::refine {
namespace {

using glm::ivec3;

class Restorer {
 public:
  Restorer(gpu::Context& context, const SparseVolume& volume, const SparseVolume& hull,
           std::span<const Camera> cameras, std::span<const carving::Silhouette> silhouettes,
           const RestoreOptions& options)
      : volume_(volume), hull_(hull), silhouettes_(silhouettes), options_(options) {
    for (const Camera& camera : cameras) cameras_.push_back(projtex::to_grid(camera, hull.grid));
    draw(context);
  }

  /// Voxels that came back, as a volume with the hull's distances at them and their neighbours.
  SparseVolume run(std::size_t& restored) const {
    SparseVolume out;
    out.grid = hull_.grid;
    out.table.assign(hull_.table.size(), SparseVolume::kOutside);
    std::vector<ivec3> bricks;
    const ivec3 n = hull_.grid.bricks;
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x) {
          const std::size_t index = hull_.grid.brick_index({x, y, z});
          if (hull_.table[index] != SparseVolume::kOutside &&
              volume_.table[index] != SparseVolume::kInside)
            bricks.emplace_back(x, y, z);
        }
    std::vector<std::vector<ivec3>> found(bricks.size());
    tbb::parallel_for(std::size_t(0), bricks.size(), [&](std::size_t b) {
      for (int i = 0; i < kBrickVoxels; ++i) {
        const ivec3 voxel = bricks[b] * kBrickEdge + ivec3(i >> 6, (i >> 3) & 7, i & 7);
        if (hull_.at(voxel) < 0 && volume_.at(voxel) > 0.5f && asked_for(glm::dvec3(voxel)))
          found[b].push_back(voxel);
      }
    });
    for (const std::vector<ivec3>& part : found) {
      restored += part.size();
      for (const ivec3& voxel : part)
        for (int x = -1; x <= 1; ++x)
          for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z) store(out, voxel + ivec3(x, y, z));
    }
    return out;
  }

 private:
  void draw(gpu::Context& context) {
    std::vector<glm::ivec4> voxels(1, glm::ivec4(0));
    for (std::size_t slot = 0; slot < volume_.bricks.size(); ++slot)
      for (int i = 0; i < kBrickVoxels; ++i) {
        const float d = volume_.distance[slot * kBrickVoxels + std::size_t(i)];
        if (d <= 0.3f && d > -1)
          voxels.emplace_back(
              volume_.bricks[slot] * kBrickEdge + ivec3(i >> 6, (i >> 3) & 7, i & 7), 0);
      }
    voxels[0].x = int(voxels.size() - 1);
    visibility::DepthMaps maps(cameras_, volume_.grid);
    std::vector<shaders::GpuView> views;
    for (const auto& camera : cameras_)
      views.push_back(projtex::to_gpu_view(camera, glm::ivec2(camera.width, camera.height)));
    const gpu::Buffer view_buffer = gpu::Buffer::of(views);
    view_buffer.bind_storage(0);
    maps.splat(context, gpu::Buffer::of(voxels), voxels.size() - 1);
    infos_ = maps.infos();
    for (std::size_t v = 0; v < cameras_.size(); ++v) depths_.push_back(maps.download(v));
  }

  /// Does the view show foreground at the point, and nothing of the volume?
  bool uncovered(std::size_t v, const glm::dvec3& point) const {
    const SilhouetteDistance* s = silhouettes_[v].distance;
    const glm::dvec3 q = cameras_[v].projection * glm::dvec4(point, 1);
    if (!s || q.z <= 1) return false;
    const double x = q.x / q.z, y = q.y / q.z;
    const int px = int(std::floor(x + 0.5)), py = int(std::floor(y + 0.5));
    if (px < 0 || py < 0 || px >= s->width || py >= s->height) return false;
    if (s->pixels[std::size_t(py) * s->width + px] > -options_.least_inside) return false;
    const auto& info = infos_[v];
    const int tx = std::clamp(int((x + 0.5) * info.scale.x), 0, info.size.x - 1);
    const int ty = std::clamp(int((y + 0.5) * info.scale.x), 0, info.size.y - 1);
    return std::isinf(depths_[v][std::size_t(ty) * info.size.x + tx]);
  }

  bool asked_for(const glm::dvec3& point) const {
    int count = 0;
    for (std::size_t v = 0; v < cameras_.size() && count < options_.least_views; ++v)
      count += uncovered(v, point);
    return count >= options_.least_views;
  }

  void store(SparseVolume& out, const ivec3& voxel) const {
    if (glm::any(glm::lessThan(voxel, ivec3(0))) ||
        glm::any(glm::greaterThanEqual(voxel, out.grid.voxels())))
      return;
    std::uint32_t& entry = out.table[out.grid.brick_index(voxel / kBrickEdge)];
    if (entry == SparseVolume::kOutside) {
      entry = std::uint32_t(out.bricks.size());
      out.bricks.push_back(voxel / kBrickEdge);
      out.distance.resize(out.distance.size() + kBrickVoxels, SparseVolume::kBand);
    }
    out.distance[std::size_t(entry) * kBrickVoxels + std::size_t(voxel_offset(voxel & 7))] =
        hull_.at(voxel);
  }

  const SparseVolume& volume_;
  const SparseVolume& hull_;
  std::span<const carving::Silhouette> silhouettes_;
  const RestoreOptions& options_;
  std::vector<projtex::GridCamera> cameras_;
  std::vector<shaders::DepthMapInfo> infos_;
  std::vector<std::vector<float>> depths_;
};

}  // namespace

std::size_t restore_silhouettes(gpu::Context& context, SparseVolume& volume,
                                const SparseVolume& hull, std::span<const Camera> cameras,
                                std::span<const carving::Silhouette> silhouettes,
                                const RestoreOptions& options) {
  std::size_t restored = 0;
  const SparseVolume parts =
      Restorer(context, volume, hull, cameras, silhouettes, options).run(restored);
  if (restored > 0) volume = union_of(volume, parts);
  return restored;
}

}  // namespace photohull::refine
