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

/// Vertices on the device, in parts that a storage block holds.
struct Batch {
  std::size_t first, count;
  Buffer parameters, vertices;
};

std::vector<Batch> upload(const std::vector<shaders::BakeVertex>& vertices, std::size_t views,
                          double noise_sigma) {
  std::vector<Batch> out;
  for (std::size_t first = 0; first < vertices.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, vertices.size() - first);
    const shaders::BakeParameters parameters{{int(count), int(views), 0, 0},
                                             {float(noise_sigma), 0, 0, 0}};
    out.push_back({first, count, Buffer(sizeof parameters, &parameters),
                   Buffer(count * sizeof(shaders::BakeVertex), &vertices[first])});
  }
  return out;
}

void splat(gpu::Context& context, const gpu::Program& program, const std::vector<Batch>& batches,
           std::size_t views) {
  for (const Batch& batch : batches) {
    batch.parameters.bind_uniform(0);
    batch.vertices.bind_storage(1);
    program.dispatch(context, "render_splat_points",
                     gpu::group_count(batch.count, 64 * shaders::kSplatRun), views);
  }
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
  const std::vector<shaders::BakeVertex> vertices = render::to_voxels(grid, mesh);
  const std::vector<Batch> batches = upload(vertices, cameras.size(), noise_sigma);
  {
    const auto program = gpu::Program::compute("render_splat_points.comp.glsl");
    const auto between = render::points_between(mesh, vertices);
    splat(context, program, batches, cameras.size());
    splat(context, program, upload(between, cameras.size(), noise_sigma), cameras.size());
  }

  const gpu::Program bake = gpu::Program::compute("render_bake_vertices.comp.glsl");
  const std::size_t total = mesh.positions.size();
  mesh.colours.assign(total, glm::vec3(0));
  mesh.confidence.assign(total, 0);
  std::vector<render::SurfaceEvidence> said(total);
  images.texture().bind(0);
  for (const Batch& batch : batches) {
    progress.check_cancelled();
    const Buffer lists = Buffer::of(
        render::list_views(std::span(vertices).subspan(batch.first, batch.count), gpu_views));
    const Buffer baked(batch.count * sizeof(shaders::BakeResult));
    batch.parameters.bind_uniform(0);
    batch.vertices.bind_storage(1);
    baked.bind_storage(2);
    lists.bind_storage(3);
    bake.dispatch(context, "render_bake_vertices",
                  gpu::group_count(batch.count, shaders::kBakeGroup));
    const auto results = baked.download<shaders::BakeResult>(batch.count);
    for (std::size_t i = 0; i < batch.count; ++i) {
      const glm::vec4& e = results[i].evidence;
      mesh.colours[batch.first + i] = glm::vec3(results[i].colour);
      said[batch.first + i] = {results[i].colour.w, e.x, e.y, e.z, e.w};
    }
    progress.update(double(batch.first + batch.count) / double(total));
  }
  std::vector<render::PooledEvidence> pooled = render::pool_evidence(mesh, said);
  BakeReport counts;
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
