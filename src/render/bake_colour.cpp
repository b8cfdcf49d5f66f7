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
#include "shared/bake.h"
#include "visibility/depth_maps.h"

namespace photohull {
namespace {

using gpu::Buffer;

constexpr std::size_t kBatchVertices = std::size_t(1) << 20;  // 32 MiB of vertices a dispatch
constexpr std::size_t kBatchPoints = std::size_t(1) << 21;    // 32 MiB of occluders a dispatch

/// Draws the mesh into the depth maps as points a voxel apart.
void draw_occluders(gpu::Context& context, const GridSpec& grid, const TriMesh& mesh,
                    visibility::DepthMaps& maps) {
  const std::vector<glm::ivec4> points = render::surface_points(grid, mesh);
  for (std::size_t first = 0; first < points.size(); first += kBatchPoints) {
    const std::size_t count = std::min(kBatchPoints, points.size() - first);
    Buffer buffer((count + 1) * sizeof(glm::ivec4));
    const glm::ivec4 header(int(count), 0, 0, 0);
    buffer.write(0, sizeof header, &header);
    buffer.write(sizeof header, count * sizeof(glm::ivec4), &points[first]);
    maps.splat(context, buffer, count);
  }
}

std::vector<shaders::BakeVertex> to_voxels(const GridSpec& grid, const TriMesh& mesh,
                                           std::size_t first, std::size_t count) {
  std::vector<shaders::BakeVertex> out(count);
  for (std::size_t i = 0; i < count; ++i) {
    const glm::dvec3 voxel = (mesh.world(first + i) - grid.origin) / grid.voxel_size;
    out[i] = {glm::vec4(glm::vec3(voxel), 0), glm::vec4(mesh.normals[first + i], 0)};
  }
  return out;
}

}  // namespace

void bake_colour(gpu::Context& context, const GridSpec& grid, const projtex::ImageSet& images,
                 std::span<const Camera> cameras, double noise_sigma, TriMesh& mesh,
                 Progress& progress, BakeReport* report) {
  PHOTOHULL_CHECK_OP(int(cameras.size()), ==, images.layers());
  PHOTOHULL_CHECK_OP(mesh.normals.size(), ==, mesh.positions.size());
  PHOTOHULL_CHECK_OP(noise_sigma, >, 0.0);
  std::vector<projtex::GridCamera> grid_cameras;
  std::vector<shaders::GpuView> gpu_views;
  const glm::ivec2 array_size(images.texture().width(), images.texture().height());
  for (const Camera& camera : cameras) {
    grid_cameras.push_back(projtex::to_grid(camera, grid));
    gpu_views.push_back(projtex::to_gpu_view(grid_cameras.back(), array_size));
  }
  const Buffer views = Buffer::of(gpu_views);
  views.bind_storage(0);
  visibility::DepthMaps maps(grid_cameras, grid);
  draw_occluders(context, grid, mesh, maps);

  const gpu::Program bake = gpu::Program::compute("render_bake_vertices.comp.glsl");
  const std::size_t total = mesh.positions.size();
  mesh.colours.assign(total, glm::vec3(0));
  mesh.confidence.assign(total, 0);
  BakeReport counts;
  for (std::size_t first = 0; first < total; first += kBatchVertices) {
    progress.check_cancelled();
    const std::size_t count = std::min(kBatchVertices, total - first);
    const shaders::BakeParameters parameters{{int(count), int(cameras.size()), 0, 0},
                                             {float(noise_sigma), 0, 0, 0}};
    const Buffer parameter_buffer(sizeof parameters, &parameters);
    const Buffer vertices = Buffer::of(to_voxels(grid, mesh, first, count));
    const Buffer baked(count * sizeof(glm::vec4));
    parameter_buffer.bind_uniform(0);
    vertices.bind_storage(1);
    baked.bind_storage(2);
    maps.bind();
    images.texture().bind(0);
    bake.dispatch(context, "render_bake_vertices", gpu::group_count(count, 64));
    const auto results = baked.download<glm::vec4>(count);
    for (std::size_t i = 0; i < count; ++i) {
      mesh.colours[first + i] = glm::vec3(results[i]);
      mesh.confidence[first + i] = results[i].w;
      counts.seen += results[i].w > 0;
      counts.mean_confidence += results[i].w;
    }
    progress.update(double(first + count) / double(total));
  }
  render::fill_unseen(mesh);
  counts.vertices = std::int64_t(total);
  if (counts.seen > 0) counts.mean_confidence /= double(counts.seen);
  if (report) *report = counts;
}

}  // namespace photohull
