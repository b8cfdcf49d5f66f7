// Offset and slopes of patches by Gauss-Newton on normalised colours [Goesele07; Furukawa10].
#include "refine/kernels/fit_patches.h"

#include <algorithm>

#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "projtex/device_views.h"
#include "refine/kernels/device_choice.h"
#include "render/kernels/device_points.h"

namespace photohull::refine {
namespace {

using gpu::Buffer;

constexpr std::size_t kBatch = std::size_t(1) << 18;  // surfels on the device at once

/// As render::to_voxels has them.
std::vector<glm::vec3> positions_in_voxels(const GridSpec& grid, const TriMesh& mesh) {
  std::vector<glm::vec3> out;
  out.reserve(mesh.positions.size());
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    out.push_back(render::to_voxels(grid, mesh, i).position);
  return out;
}

shaders::FitParameters parameters_of(std::size_t surfels, double noise_sigma, const FitOptions& o) {
  shaders::FitParameters p{};
  p.counts = {int(surfels), 0, o.steps, 0};
  p.search = {float(o.least_spacing), float(o.pixel_spacing), float(o.largest_offset),
              float(o.largest_step)};
  p.robust = {float(o.noise * noise_sigma * noise_sigma), float(o.least_score), float(o.full_score),
              float(o.slope)};
  return p;
}

PatchFit from_device(const shaders::FitResult& r) {
  return {glm::vec3(r.plane), r.plane.w, r.evidence.x, r.evidence.y, r.evidence.z, r.evidence.w};
}

/// The surfels on the device, batch by batch.
class Fitter {
 public:
  Fitter(gpu::Context& context, const projtex::Photographs& photographs, const GridSpec& grid,
         const FitOptions& options)
      : context_(context),
        photographs_(photographs),
        options_(options),
        views_(projtex::to_gpu_views(projtex::to_grid(photographs.cameras, grid),
                                     photographs.images)) {}

  std::vector<PatchFit> fit(std::span<const render::SurfacePoint> surfels,
                            std::span<const glm::vec3> bends, const Buffer& choices) const {
    const glm::vec3 first(options_.first_voxel);
    std::vector<shaders::FitShape> shapes;
    for (std::size_t i = 0; i < surfels.size(); ++i)
      shapes.push_back(
          {glm::vec4(bends[i], holds_out(surfels[i].position + first, options_.hold_out))});
    const auto program =
        gpu::Program::compute(context_, "refine_fit_patches.comp.glsl", views_.defines());
    const shaders::FitParameters parameters =
        parameters_of(surfels.size(), photographs_.noise_sigma, options_);
    const Buffer uniforms(sizeof parameters, &parameters), points = render::to_device(surfels);
    const Buffer shape = Buffer::of(shapes);
    const Buffer results(surfels.size() * sizeof(shaders::FitResult));
    uniforms.bind_uniform(shaders::kFitParametersBinding);
    views_.bind();
    points.bind_storage(shaders::kFitSurfelsBinding);
    choices.bind_storage(shaders::kFitChoicesBinding);
    results.bind_storage(shaders::kFitResultsBinding);
    shape.bind_storage(shaders::kFitShapesBinding);
    photographs_.images.texture().bind(shaders::kImagesUnit);
    program->dispatch(context_, "refine_fit_patches",
                      gpu::group_count(surfels.size(), shaders::kPatchGroup));
    std::vector<PatchFit> out;
    for (const auto& result : results.download<shaders::FitResult>(surfels.size()))
      out.push_back(from_device(result));
    return out;
  }

 private:
  gpu::Context& context_;
  const projtex::Photographs& photographs_;
  const FitOptions& options_;
  projtex::DeviceViews views_;
};

}  // namespace

SurfelShapes shapes_of(const MeshSurfels& surfels, const FitOptions& options) {
  std::vector<glm::vec3> positions = positions_in_voxels(surfels.grid, surfels.mesh);
  std::vector<glm::vec3> bends =
      curvatures(surfels.graph, positions, surfels.mesh.normals, options.most_bend);
  return {std::move(positions), surfels.mesh.normals, std::move(bends)};
}

std::vector<PatchFit> unfitted(std::span<const glm::vec3> normals) {
  std::vector<PatchFit> out(normals.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i].normal = normals[i];
  return out;
}

std::vector<PatchFit> fit_patches(gpu::Context& context, const MeshSurfels& surfels,
                                  const MatchingPhotographs& photographs,
                                  std::span<const ViewChoice> choices, const FitOptions& options) {
  return fit_surfels(context, surfels.grid, shapes_of(surfels, options), photographs, choices,
                     options);
}

std::vector<PatchFit> fit_surfels(gpu::Context& context, const GridSpec& grid,
                                  const SurfelShapes& surfels,
                                  const MatchingPhotographs& photographs,
                                  std::span<const ViewChoice> choices, const FitOptions& options) {
  PHOTOHULL_CHECK_OP(choices.size(), ==, surfels.positions.size());
  std::vector<PatchFit> out = unfitted(surfels.normals);
  const std::size_t batch = gpu::batch_size(sizeof(shaders::MatchChoice), kBatch);
  photographs.for_each(
      choices, [&](const projtex::Photographs& held, std::span<const std::uint32_t> fitted,
                   const HeldNumbers& numbers) {
        const Fitter fitter(context, held, grid, options);
        for (std::size_t first = 0; first < fitted.size(); first += batch) {
          const auto part = fitted.subspan(first, std::min(batch, fitted.size() - first));
          std::vector<render::SurfacePoint> points;
          std::vector<glm::vec3> bent;
          std::vector<ViewChoice> views;
          for (const std::uint32_t i : part) {
            points.push_back({surfels.positions[i], surfels.normals[i]});
            bent.push_back(surfels.bends[i]);
            views.push_back(numbers.of(choices[i]));
          }
          const std::vector<PatchFit> fits = fitter.fit(points, bent, to_device(views));
          for (std::size_t k = 0; k < part.size(); ++k) out[part[k]] = fits[k];
        }
      });
  return out;
}

}  // namespace photohull::refine
