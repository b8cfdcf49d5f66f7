// Patches on tangent planes [Montenegro03], scored by correlation with a reference view
// [Goesele07].
#include "refine/match.h"

#include <cmath>
#include <optional>

#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "render/surface_points.h"
#include "render/view_lists.h"
#include "shared/bake.h"

namespace photohull::refine {
namespace {

using gpu::Buffer;

constexpr double kRadians = 0.017453292519943295;
constexpr std::size_t kBatch = std::size_t(1) << 18;  // surfels on the device at once
constexpr std::size_t kMostThreads = std::size_t(1)
                                     << 21;            // of a dispatch: within every device's limit
constexpr std::size_t kPoints = std::size_t(1) << 20;  // drawn at once

shaders::MatchParameters parameters_of(std::size_t views, double noise_sigma,
                                       const OffsetRange& range, const MatchOptions& o) {
  const auto cosine = [](double degrees) { return float(std::cos(kRadians * degrees)); };
  shaders::MatchParameters p{};
  p.counts = {0, int(views), range.count, 0};
  p.search = {float(range.first), float(range.step), float(o.least_spacing),
              float(o.pixel_spacing)};
  p.consistency = {float(noise_sigma * noise_sigma), float(o.best_pairs), 0, 0};
  p.visibility = {float(o.shift), float(o.depth_bias), float(o.least_cosine), float(o.seen_cosine)};
  p.angles = {cosine(o.nearest_angle), cosine(o.farthest_angle), cosine(o.duplicate_angle), 0};
  return p;
}

/// A mesh's vertices as surfels on the device, and who sees them.
class Matcher {
 public:
  Matcher(gpu::Context& context, const GridSpec& grid, const TriMesh& mesh,
          const projtex::ImageSet& images, std::span<const Camera> cameras)
      : context_(context),
        images_(images),
        surfels_(render::to_voxels(grid, mesh)),
        maps_(render::occluder_maps(cameras, grid)),
        choose_(gpu::Program::compute("refine_choose_views.comp.glsl")) {
    const glm::ivec2 size(images.texture().width(), images.texture().height());
    for (const Camera& camera : cameras)
      gpu_views_.push_back(projtex::to_gpu_view(projtex::to_grid(camera, grid), size));
    views_ = Buffer::of(gpu_views_);
    views_.bind_storage(0);
    maps_.bind();
    draw(surfels_);
    draw(render::points_between(mesh, surfels_));
    for (shaders::BakeVertex& surfel : surfels_) surfel.position.w = 1;  // scale of the offsets
  }

  void match(const shaders::MatchParameters& parameters, std::span<const glm::vec3> bends,
             Matches& out, std::vector<shaders::MatchChoice>* chosen) {
    const auto program = gpu::Program::compute("refine_match_patches.comp.glsl",
                                               bends.empty() ? "" : "#define PATCH_BENT\n");
    const std::size_t offsets = std::size_t(out.range.count);
    out.scores.resize(surfels_.size() * offsets);
    for_batches(
        kMostThreads / offsets, parameters,
        [&](std::size_t first, std::size_t count, const Buffer& choices) {
          const Buffer scores(count * offsets * sizeof(float));
          scores.bind_storage(3);
          const Buffer textures(count * sizeof(float));
          textures.bind_storage(5);
          Buffer curvature;
          if (!bends.empty()) {
            std::vector<glm::vec4> part;
            for (const glm::vec3& b : bends.subspan(first, count)) part.emplace_back(b, 0);
            curvature = Buffer::of(part);
            curvature.bind_storage(4);
          }
          program.dispatch(context_, "refine_match_patches", gpu::group_count(count * offsets, 64));
          scores.read(0, count * offsets * sizeof(float), out.scores.data() + first * offsets);
          const auto texture = textures.download<float>(count);
          out.texture.insert(out.texture.end(), texture.begin(), texture.end());
          for (const auto& choice : choices.download<shaders::MatchChoice>(count)) {
            if (chosen) chosen->push_back(choice);
            out.seen.push_back(choice.second.z > 0);
            if (choice.second.w >= 2)
              out.samples += std::int64_t(offsets) * choice.second.w * shaders::kMatchTaps;
          }
        });
  }

 private:
  /// Chooses views for the surfels, a batch at a time, and calls f(first, count, choices, lists)
  /// with the choices and what comes before them bound.
  template <typename F>
  void for_batches(std::size_t most, shaders::MatchParameters parameters, F&& f) {
    const std::size_t batch = std::min(kBatch, most);
    for (std::size_t first = 0; first < surfels_.size(); first += batch) {
      const std::size_t count = std::min(batch, surfels_.size() - first);
      const auto part = std::span<const shaders::BakeVertex>(surfels_).subspan(first, count);
      const Buffer surfels = Buffer::of(part);
      const Buffer lists =
          Buffer::of(render::list_views(part, gpu_views_, parameters.visibility.w));
      const Buffer choices(count * sizeof(shaders::MatchChoice));
      parameters.counts.x = int(count);
      const Buffer uniforms(sizeof parameters, &parameters);
      uniforms.bind_uniform(0);
      views_.bind_storage(0);
      maps_.bind();
      surfels.bind_storage(1);
      choices.bind_storage(2);
      lists.bind_storage(3);
      choose_.dispatch(context_, "refine_choose_views",
                       gpu::group_count(count, shaders::kBakeGroup));
      images_.texture().bind(0);
      f(first, count, choices);
    }
  }

  void draw(const std::vector<shaders::BakeVertex>& points) {
    const auto splat = gpu::Program::compute("render_splat_points.comp.glsl");
    for (std::size_t first = 0; first < points.size(); first += kPoints) {
      const std::size_t count = std::min(kPoints, points.size() - first);
      const shaders::BakeParameters parameters{{int(count), int(gpu_views_.size()), 0, 0}, {}};
      const Buffer uniforms(sizeof parameters, &parameters);
      const Buffer part(count * sizeof(shaders::BakeVertex), &points[first]);
      uniforms.bind_uniform(0);
      part.bind_storage(1);
      splat.dispatch(context_, "render_splat_points",
                     gpu::group_count(count, 64 * shaders::kSplatRun), gpu_views_.size());
    }
  }

  gpu::Context& context_;
  const projtex::ImageSet& images_;
  std::vector<shaders::BakeVertex> surfels_;
  std::vector<shaders::GpuView> gpu_views_;
  Buffer views_;
  visibility::DepthMaps maps_;
  gpu::Program choose_;
};

}  // namespace

Matches match_patches(gpu::Context& context, const GridSpec& grid, const TriMesh& mesh,
                      std::span<const glm::vec3> bends, const projtex::ImageSet& images,
                      std::span<const Camera> cameras, double noise_sigma, const OffsetRange& range,
                      const MatchOptions& options, std::vector<shaders::MatchChoice>* choices) {
  Matches out;
  out.range = range;
  Matcher(context, grid, mesh, images, cameras)
      .match(parameters_of(cameras.size(), noise_sigma, range, options), bends, out, choices);
  return out;
}

std::vector<float> correlate_pairs(gpu::Context& context, const GridSpec& grid,
                                   std::span<const shaders::BakeVertex> surfels,
                                   std::span<const shaders::MatchChoice> pairs,
                                   const projtex::ImageSet& images, std::span<const Camera> cameras,
                                   double noise_sigma, const MatchOptions& options) {
  PHOTOHULL_CHECK_OP(surfels.size(), ==, pairs.size());
  std::vector<float> out(surfels.size());
  if (surfels.empty()) return out;
  const glm::ivec2 size(images.texture().width(), images.texture().height());
  std::vector<shaders::GpuView> gpu_views;
  for (const Camera& camera : cameras)
    gpu_views.push_back(projtex::to_gpu_view(projtex::to_grid(camera, grid), size));
  const Buffer views = Buffer::of(gpu_views);
  const auto program = gpu::Program::compute("refine_match_patches.comp.glsl");
  shaders::MatchParameters parameters = parameters_of(cameras.size(), noise_sigma, {}, options);
  for (std::size_t first = 0; first < surfels.size(); first += kBatch) {
    const std::size_t count = std::min(kBatch, surfels.size() - first);
    parameters.counts.x = int(count);
    const Buffer uniforms(sizeof parameters, &parameters);
    const Buffer part = Buffer::of(surfels.subspan(first, count));
    const Buffer choices = Buffer::of(pairs.subspan(first, count));
    const Buffer scores(count * sizeof(float)), textures(count * sizeof(float));
    uniforms.bind_uniform(0);
    views.bind_storage(0);
    part.bind_storage(1);
    choices.bind_storage(2);
    scores.bind_storage(3);
    textures.bind_storage(5);
    images.texture().bind(0);
    program.dispatch(context, "refine_correlate_pairs", gpu::group_count(count, 64));
    scores.read(0, count * sizeof(float), out.data() + first);
  }
  return out;
}

}  // namespace photohull::refine
