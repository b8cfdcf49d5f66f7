// Visibility as in L. Williams, "Casting curved shadows on curved surfaces", SIGGRAPH 1978; weights
// in the spirit of P. Debevec, C. Taylor, J. Malik, "Modeling and rendering architecture from
// photographs", SIGGRAPH 1996.
#include "render/bake_colour.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "render/surface_points.h"
#include "render/view_lists.h"
#include "shared/bake.h"
#include "visibility/depth_maps.h"

namespace photohull {
namespace {

using gpu::Buffer;

constexpr std::size_t kBatch = std::size_t(1) << 20;  // 32 MiB of vertices a dispatch

/// Some of the vertices on the device.
struct Batch {
  Batch(std::span<const shaders::BakeVertex> part, std::size_t views, double noise_sigma)
      : parameters_of{{int(part.size()), int(views), 0, 0}, {float(noise_sigma), 0, 0, 0}},
        parameters(sizeof parameters_of, &parameters_of),
        vertices(part.size_bytes(), part.data()) {
    parameters.bind_uniform(0);
    vertices.bind_storage(1);
  }
  shaders::BakeParameters parameters_of;
  Buffer parameters, vertices;
};

/// Calls visit(first, part) for the vertices in parts of at most kBatch, fewer where a storage
/// block does not hold them or their lists of views.
template <typename Visit>
void for_batches(std::span<const shaders::BakeVertex> vertices, std::size_t views, Visit&& visit) {
  const std::size_t batch = render::listed_batch(sizeof(shaders::BakeVertex), kBatch, views);
  for (std::size_t first = 0; first < vertices.size(); first += batch)
    visit(first, vertices.subspan(first, std::min(batch, vertices.size() - first)));
}

void splat(gpu::Context& context, const gpu::Program& program,
           std::span<const shaders::BakeVertex> points, std::size_t views, double noise_sigma) {
  for_batches(points, views, [&](std::size_t, std::span<const shaders::BakeVertex> part) {
    const Batch batch(part, views, noise_sigma);
    program.dispatch(context, "render_splat_points",
                     gpu::group_count(part.size(), 64 * shaders::kSplatRun), views);
  });
}

}  // namespace

void bake_colour(gpu::Context& context, const GridSpec& grid, const projtex::ImageSet& images,
                 std::span<const Camera> cameras, double noise_sigma, render::Shaping shaping,
                 TriMesh& mesh, Progress& progress, BakeReport* report,
                 std::vector<render::PooledEvidence>* evidence) {
  PHOTOHULL_CHECK_OP(int(cameras.size()), ==, images.layers());
  PHOTOHULL_CHECK_OP(mesh.normals.size(), ==, mesh.positions.size());
  PHOTOHULL_CHECK_OP(noise_sigma, >, 0.0);
  const glm::ivec2 array_size(images.texture().width(), images.texture().height());
  std::vector<shaders::GpuView> gpu_views;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    gpu_views.push_back(projtex::to_gpu_view(projtex::to_grid(cameras[i], grid), array_size,
                                             images.sharpness()[i]));
  const Buffer views = Buffer::of(gpu_views);
  const visibility::DepthMaps maps = render::occluder_maps(cameras, grid);
  views.bind_storage(0);
  maps.bind();
  std::vector<shaders::BakeVertex> vertices = render::to_voxels(grid, mesh);
  {
    const auto program = gpu::Program::compute("render_splat_points.comp.glsl", maps.defines());
    splat(context, program, vertices, cameras.size(), noise_sigma);
    splat(context, program, render::points_between(mesh, vertices), cameras.size(), noise_sigma);
  }

  const gpu::Program bake = gpu::Program::compute("render_bake_vertices.comp.glsl", maps.defines());
  const std::size_t total = mesh.positions.size();
  mesh.colours.assign(total, glm::vec3(0));
  mesh.confidence.assign(total, 0);
  std::vector<render::SurfaceEvidence> said(total);
  images.texture().bind(0);
  for_batches(vertices, cameras.size(),
              [&](std::size_t first, std::span<const shaders::BakeVertex> part) {
                progress.check_cancelled();
                const Batch batch(part, cameras.size(), noise_sigma);
                const Buffer lists = Buffer::of(render::list_views(part, gpu_views));
                const Buffer baked(part.size() * sizeof(shaders::BakeResult));
                baked.bind_storage(2);
                lists.bind_storage(3);
                bake.dispatch(context, "render_bake_vertices",
                              gpu::group_count(part.size(), shaders::kBakeGroup));
                const auto results = baked.download<shaders::BakeResult>(part.size());
                for (std::size_t i = 0; i < part.size(); ++i) {
                  const glm::vec4& e = results[i].evidence;
                  mesh.colours[first + i] = glm::vec3(results[i].colour);
                  said[first + i] = {results[i].colour.w, e.x, e.y, e.z, e.w};
                }
                progress.update(double(first + part.size()) / double(total));
              });
  vertices = {};
  std::vector<render::PooledEvidence> pooled = render::pool_evidence(mesh, said);
  BakeReport counts;
  said = {};
  for (std::size_t i = 0; i < total; ++i) {
    mesh.confidence[i] = float(render::confidence_of(pooled[i], shaping));
    counts.seen += pooled[i].seen;
    counts.mean_confidence += mesh.confidence[i];
  }
  render::fill_unseen(mesh);
  counts.vertices = std::int64_t(total);
  if (counts.seen > 0) counts.mean_confidence /= double(counts.seen);
  if (report) *report = counts;
  if (evidence) *evidence = std::move(pooled);
}

}  // namespace photohull
