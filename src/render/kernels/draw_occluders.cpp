#include "render/kernels/draw_occluders.h"

#include <algorithm>

#include "core/error.h"
#include "gpu/program.h"
#include "render/kernels/device_points.h"
#include "shared/surface_points.h"
#include "shared/view.h"

namespace photohull::render {
namespace {

constexpr std::size_t kBatch = std::size_t(1) << 20;  // points, 32 MiB a dispatch

/// Into the depth maps and from the views, which are bound.
void splat(gpu::Context& context, const visibility::DepthMaps& maps,
           const projtex::DeviceViews& views, std::span<const SurfacePoint> points) {
  const auto program = gpu::Program::compute(context, "render_splat_points.comp.glsl",
                                             concat(maps.defines(), views.defines()));
  const std::size_t batch = gpu::batch_size(sizeof(shaders::SurfacePoint), kBatch);
  for (std::size_t first = 0; first < points.size(); first += batch) {
    const auto part = points.subspan(first, std::min(batch, points.size() - first));
    const shaders::SplatParameters parameters{{int(part.size()), 0, 0, 0}};
    const gpu::Buffer uniforms(sizeof parameters, &parameters), part_buffer = to_device(part);
    uniforms.bind_uniform(shaders::kSplatParametersBinding);
    part_buffer.bind_storage(shaders::kSplatPointsBinding);
    program->dispatch(context, "render_splat_points",
                      gpu::group_count(part.size(), shaders::kSplatGroup * shaders::kSplatRun),
                      maps.infos().size());
  }
}

}  // namespace

visibility::DepthMaps draw_occluders(gpu::Context& context, const GridSpec& grid,
                                     const projtex::Photographs& photographs,
                                     const projtex::DeviceViews& views, const TriMesh& mesh,
                                     std::span<const SurfacePoint> vertices) {
  visibility::DepthMaps maps = occluder_maps(photographs.cameras, grid, photographs.cut_at());
  if (photographs.are_of_part()) maps.draw(photographs.beside, 1 / grid.voxel_size);
  views.bind();
  maps.bind();
  splat(context, maps, views, vertices);
  splat(context, maps, views, points_between(mesh, vertices));
  return maps;
}

}  // namespace photohull::render
