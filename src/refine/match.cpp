// Patches on tangent planes [Montenegro03], scored by correlation with a reference view
// [Goesele07].
#include "refine/match.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "refine/pick.h"
#include "render/surface_points.h"
#include "render/view_lists.h"
#include "shared/bake.h"

namespace photohull::refine {
namespace {

using gpu::Buffer;

constexpr double kRadians = 0.017453292519943295;
constexpr std::size_t kBatch = std::size_t(1) << 18;        // surfels on the device at once
constexpr std::size_t kMostThreads = std::size_t(1) << 21;  // of a dispatch
constexpr std::size_t kPoints = std::size_t(1) << 20;       // drawn at once

shaders::MatchParameters parameters_of(std::size_t views, double noise_sigma,
                                       const OffsetRange& range, const MatchOptions& o) {
  const auto cosine = [](double degrees) { return float(std::cos(kRadians * degrees)); };
  shaders::MatchParameters p{};
  p.counts = {0, int(views), range.count, 0};
  p.search = {float(range.first), float(range.step), float(o.least_spacing),
              float(o.pixel_spacing)};
  p.consistency = {float(noise_sigma * noise_sigma), float(o.best_pairs),
                   float(variance_floor(noise_sigma)), 0};
  p.visibility = {float(o.shift), float(o.depth_bias), float(o.least_cosine), float(o.seen_cosine)};
  p.angles = {cosine(o.nearest_angle), cosine(o.farthest_angle), cosine(o.duplicate_angle), 0};
  return p;
}

std::vector<shaders::GpuView> views_on(const GridSpec& grid, const projtex::ImageSet& images,
                                       std::span<const Camera> cameras) {
  const glm::ivec2 size(images.texture().width(), images.texture().height());
  std::vector<shaders::GpuView> out;
  for (std::size_t i = 0; i < cameras.size(); ++i)
    out.push_back(
        projtex::to_gpu_view(projtex::to_grid(cameras[i], grid), size, images.sharpness()[i]));
  return out;
}

/// Draws points into the depth maps that are bound.
void draw(gpu::Context& context, const visibility::DepthMaps& maps,
          std::span<const shaders::BakeVertex> points, std::size_t views) {
  const auto splat = gpu::Program::compute("render_splat_points.comp.glsl", maps.defines());
  const std::size_t batch = gpu::batch_size(sizeof(shaders::BakeVertex), kPoints);
  for (std::size_t first = 0; first < points.size(); first += batch) {
    const std::size_t count = std::min(batch, points.size() - first);
    const shaders::BakeParameters parameters{{int(count), int(views), 0, 0}, {}};
    const Buffer uniforms(sizeof parameters, &parameters);
    const Buffer part(count * sizeof(shaders::BakeVertex), &points[first]);
    uniforms.bind_uniform(0);
    part.bind_storage(1);
    splat.dispatch(context, "render_splat_points", gpu::group_count(count, 64 * shaders::kSplatRun),
                   views);
  }
}

}  // namespace

std::vector<shaders::MatchChoice> choose_views(gpu::Context& context, const GridSpec& grid,
                                               const TriMesh& mesh, const projtex::ImageSet& images,
                                               std::span<const Camera> cameras,
                                               const MatchOptions& options) {
  const std::vector<shaders::BakeVertex> surfels = render::to_voxels(grid, mesh);
  const std::vector<shaders::GpuView> gpu_views = views_on(grid, images, cameras);
  const Buffer views = Buffer::of(gpu_views);
  visibility::DepthMaps maps = render::occluder_maps(cameras, grid);
  views.bind_storage(0);
  maps.bind();
  draw(context, maps, surfels, gpu_views.size());
  draw(context, maps, render::points_between(mesh, surfels), gpu_views.size());

  const auto program = gpu::Program::compute("refine_choose_views.comp.glsl", maps.defines());
  const std::size_t batch =
      render::listed_batch(sizeof(shaders::MatchChoice), kBatch, cameras.size());
  shaders::MatchParameters parameters = parameters_of(cameras.size(), 0, {}, options);
  std::vector<shaders::MatchChoice> out(surfels.size());
  for (std::size_t first = 0; first < surfels.size(); first += batch) {
    const std::size_t count = std::min(batch, surfels.size() - first);
    const auto part = std::span<const shaders::BakeVertex>(surfels).subspan(first, count);
    const Buffer points = Buffer::of(part);
    const Buffer lists = Buffer::of(render::list_views(part, gpu_views, parameters.visibility.w));
    const Buffer choices(count * sizeof(shaders::MatchChoice));
    parameters.counts.x = int(count);
    const Buffer uniforms(sizeof parameters, &parameters);
    uniforms.bind_uniform(0);
    views.bind_storage(0);
    maps.bind();
    points.bind_storage(1);
    choices.bind_storage(2);
    lists.bind_storage(3);
    program.dispatch(context, "refine_choose_views", gpu::group_count(count, shaders::kBakeGroup));
    choices.read(0, count * sizeof(shaders::MatchChoice), out.data() + first);
  }
  return out;
}

Matches match_patches(gpu::Context& context, const GridSpec& grid,
                      std::span<const shaders::BakeVertex> surfels,
                      std::span<const glm::vec3> bends,
                      std::span<const shaders::MatchChoice> choices,
                      const projtex::ImageSet& images, std::span<const Camera> cameras,
                      double noise_sigma, const OffsetRange& range, const MatchOptions& options) {
  PHOTOHULL_CHECK_OP(surfels.size(), ==, choices.size());
  const std::size_t offsets = std::size_t(range.count);
  Matches out;
  out.range = range;
  out.scores.assign(surfels.size() * offsets, shaders::kNoScore);
  out.texture.assign(surfels.size(), 1);
  const std::vector<std::uint32_t> matched = comparable(choices);

  const Buffer views = Buffer::of(views_on(grid, images, cameras));
  const auto program = gpu::Program::compute("refine_match_patches.comp.glsl",
                                             bends.empty() ? "" : "#define PATCH_BENT\n");
  shaders::MatchParameters parameters = parameters_of(cameras.size(), noise_sigma, range, options);
  const std::size_t most = std::clamp<std::size_t>(kMostThreads / offsets, 1, kBatch);
  const std::size_t batch =
      gpu::batch_size(std::max(sizeof(shaders::MatchChoice), offsets * sizeof(float)), most);
  for (std::size_t first = 0; first < matched.size(); first += batch) {
    const auto part = std::span<const std::uint32_t>(matched).subspan(
        first, std::min(batch, matched.size() - first));
    std::vector<shaders::BakeVertex> points = pick(surfels, part);
    for (shaders::BakeVertex& point : points) point.position.w = 1;  // scale of the offsets
    std::vector<glm::vec4> bent;
    if (!bends.empty())
      for (const std::uint32_t i : part) bent.emplace_back(bends[i], 0);
    parameters.counts.x = int(part.size());
    const Buffer uniforms(sizeof parameters, &parameters), point_buffer = Buffer::of(points);
    const Buffer choice_buffer = Buffer::of(pick(choices, part));
    const Buffer scores(part.size() * offsets * sizeof(float));
    const Buffer textures(part.size() * sizeof(float));
    Buffer curvature;
    uniforms.bind_uniform(0);
    views.bind_storage(0);
    point_buffer.bind_storage(1);
    choice_buffer.bind_storage(2);
    scores.bind_storage(3);
    if (!bends.empty()) {
      curvature = Buffer::of(bent);
      curvature.bind_storage(4);
    }
    textures.bind_storage(5);
    images.texture().bind(0);
    program.dispatch(context, "refine_match_patches", gpu::group_count(part.size() * offsets, 64));
    const auto score = scores.download<float>(part.size() * offsets);
    const auto texture = textures.download<float>(part.size());
    for (std::size_t k = 0; k < part.size(); ++k) {
      std::copy_n(score.begin() + std::ptrdiff_t(k * offsets), offsets,
                  out.scores.begin() + std::ptrdiff_t(part[k] * offsets));
      out.texture[part[k]] = texture[k];
      out.samples += std::int64_t(offsets) * choices[part[k]].second.w * shaders::kMatchTaps;
    }
  }
  return out;
}

}  // namespace photohull::refine
