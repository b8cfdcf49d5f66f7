#include "render/kernels/bake_vertices.h"

#include <algorithm>
#include <span>

#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "projtex/device_views.h"
#include "render/kernels/device_points.h"
#include "render/kernels/draw_occluders.h"
#include "render/view_lists.h"
#include "shared/bake.h"

namespace photohull::render {
namespace {

using gpu::Buffer;

constexpr std::size_t kBatch = std::size_t(1) << 20;  // 48 MiB of results a dispatch

}  // namespace

BakedVertices bake_vertices(gpu::Context& context, const GridSpec& grid,
                            const projtex::Photographs& photographs, const TriMesh& mesh,
                            Progress& progress) {
  const std::span<const Camera> cameras = photographs.cameras;
  const std::vector<shaders::GpuView> gpu_views =
      projtex::to_gpu_views(projtex::to_grid(cameras, grid), photographs.images);
  const projtex::DeviceViews views(gpu_views);
  const std::vector<SurfacePoint> vertices = to_voxels(grid, mesh);
  const visibility::DepthMaps maps =
      draw_occluders(context, grid, photographs, views, mesh, vertices);
  const auto program = gpu::Program::compute(context, "render_bake_vertices.comp.glsl",
                                             concat(maps.defines(), views.defines()));
  const std::size_t total = vertices.size();
  constexpr std::size_t kLargest =
      std::max(sizeof(shaders::SurfacePoint), sizeof(shaders::BakeResult));
  const std::size_t batch = listed_batch(kLargest, kBatch, cameras.size());
  BakedVertices out{std::vector<glm::vec3>(total), std::vector<SurfaceEvidence>(total)};
  photographs.images.texture().bind(shaders::kImagesUnit);
  for (std::size_t first = 0; first < total; first += batch) {
    progress.check_cancelled();
    const auto part = std::span(vertices).subspan(first, std::min(batch, total - first));
    const shaders::BakeParameters parameters{{int(part.size()), int(cameras.size()), 0, 0},
                                             {float(photographs.noise_sigma), 0, 0, 0}};
    const Buffer uniforms(sizeof parameters, &parameters), points = to_device(part);
    const Buffer lists = Buffer::of(list_views(part, gpu_views, shaders::kBakeMinCosine));
    const Buffer baked(part.size() * sizeof(shaders::BakeResult));
    views.bind();
    uniforms.bind_uniform(shaders::kBakeParametersBinding);
    points.bind_storage(shaders::kBakeVerticesBinding);
    baked.bind_storage(shaders::kBakeResultsBinding);
    lists.bind_storage(shaders::kBakeViewListsBinding);
    program->dispatch(context, "render_bake_vertices",
                      gpu::group_count(part.size(), shaders::kListedPoints));
    const auto results = baked.download<shaders::BakeResult>(part.size());
    for (std::size_t i = 0; i < part.size(); ++i) {
      const glm::vec4& e = results[i].evidence;
      out.colours[first + i] = glm::vec3(results[i].colour);
      out.evidence[first + i] = {results[i].colour.w, e.x, e.y, e.z, e.w, results[i].sight.x};
    }
    progress.update(double(first + part.size()) / double(total));
  }
  return out;
}

}  // namespace photohull::render
