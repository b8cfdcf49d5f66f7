#include "refine/kernels/choose_views.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "projtex/device_views.h"
#include "refine/kernels/device_choice.h"
#include "render/kernels/device_points.h"
#include "render/kernels/draw_occluders.h"
#include "render/view_lists.h"

namespace photohull::refine {
namespace {

using gpu::Buffer;

constexpr double kRadians = 0.017453292519943295;
constexpr std::size_t kBatch = std::size_t(1) << 18;  // surfels on the device at once

shaders::ChooseParameters parameters_of(std::size_t surfels, std::size_t views,
                                        const MatchOptions& o) {
  const auto cosine = [](double degrees) { return float(std::cos(kRadians * degrees)); };
  return {{int(surfels), int(views), 0, 0},
          {float(o.shift), float(o.depth_bias), float(o.least_cosine), float(o.seen_cosine)},
          {cosine(o.nearest_angle), cosine(o.farthest_angle), cosine(o.duplicate_angle), 0}};
}

}  // namespace

std::vector<ViewChoice> choose_views(gpu::Context& context, const GridSpec& grid,
                                     const TriMesh& mesh, const projtex::Photographs& photographs,
                                     const MatchOptions& options) {
  const std::span<const Camera> cameras = photographs.cameras;
  const std::vector<render::SurfacePoint> surfels = render::to_voxels(grid, mesh);
  const std::vector<shaders::GpuView> gpu_views =
      projtex::to_gpu_views(projtex::to_grid(cameras, grid), photographs.images);
  const projtex::DeviceViews views(gpu_views);
  const visibility::DepthMaps maps =
      render::draw_occluders(context, grid, photographs, views, mesh, surfels);
  const auto program = gpu::Program::compute(context, "refine_choose_views.comp.glsl",
                                             concat(maps.defines(), views.defines()));
  const std::size_t batch =
      render::listed_batch(sizeof(shaders::MatchChoice), kBatch, cameras.size());
  std::vector<ViewChoice> out;
  out.reserve(surfels.size());
  for (std::size_t first = 0; first < surfels.size(); first += batch) {
    const auto part = std::span(surfels).subspan(first, std::min(batch, surfels.size() - first));
    const shaders::ChooseParameters parameters =
        parameters_of(part.size(), cameras.size(), options);
    const Buffer uniforms(sizeof parameters, &parameters), points = render::to_device(part);
    const Buffer lists =
        Buffer::of(render::list_views(part, gpu_views, float(options.seen_cosine)));
    const Buffer choices(part.size() * sizeof(shaders::MatchChoice));
    uniforms.bind_uniform(shaders::kChooseParametersBinding);
    views.bind();
    maps.bind();
    points.bind_storage(shaders::kChooseSurfelsBinding);
    choices.bind_storage(shaders::kChooseChoicesBinding);
    lists.bind_storage(shaders::kChooseViewListsBinding);
    program->dispatch(context, "refine_choose_views",
                      gpu::group_count(part.size(), shaders::kListedPoints));
    for (const auto& choice : choices.download<shaders::MatchChoice>(part.size()))
      out.push_back(from_device(choice));
  }
  return out;
}

}  // namespace photohull::refine
