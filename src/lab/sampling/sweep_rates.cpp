// The sweep's kernels timed beside bare texture fetches.
#include <algorithm>
#include <random>

#include "core/error.h"
#include "gpu/buffer.h"
#include "lab/sampling/sampling_study.h"
#include "lab/sampling/study_clock.h"
#include "projtex/gpu_views.h"
#include "projtex/image_set.h"
#include "projtex/sample_images.h"
#include "shared/sampling.h"
#include "shared/sweep.h"

namespace photohull::projtex {
namespace {

constexpr int kViews = shaders::kMaxLayerViews;
constexpr int kBricks = 22;  // bricks along each side of the layer
constexpr int kWidth = 640, kHeight = 512;
constexpr int kRawTaps = 8, kRawThreads = 1 << 17;

/// Cameras that look along z at a layer whose voxels span `pixels`.
struct Layer {
  std::vector<PreparedView> views;
  std::vector<GridCamera> cameras;
  gpu::Buffer items, selected, samples, uniforms;
  std::size_t values = 0;
  int repeats;  // that timings are taken, of which the quickest counts

  Layer(double pixels, int repeated) : repeats(repeated) {
    std::mt19937 random(1);
    const GridSpec grid{{0, 0, 0}, 1.0, {kBricks, kBricks, 1}};
    for (int i = 0; i < kViews; ++i) {
      PreparedView view;
      const double depth = 600 + 2 * i, centre = 4.0 * kBricks;
      view.camera.intrinsics = {kWidth, kHeight, pixels * depth, pixels * depth, 0, 320, 256};
      view.camera.cam_from_world.translation = {-centre, -centre, depth - 3};
      view.image = {kWidth, kHeight, ColourImage::Encoding::kSrgb8, false, {}};
      view.image.bytes.resize(std::size_t(kWidth) * kHeight * 4);
      for (std::size_t b = 0; b < view.image.bytes.size(); ++b)
        view.image.bytes[b] = b % 4 == 3 ? 255 : std::uint8_t(random());
      cameras.push_back(to_grid(view.camera, grid));
      views.push_back(std::move(view));
    }
    std::vector<shaders::LayerItem> list;
    std::vector<glm::uvec4> chosen(1);
    for (int y = 0; y < kBricks; ++y)
      for (int x = 0; x < kBricks; ++x) {
        shaders::LayerItem item{};
        item.brick = {x, y, 0, kViews};
        for (int v = 0; v < kViews; ++v) item.views[v / 4][v % 4] = unsigned(v);
        chosen.emplace_back(unsigned(list.size()), ~0u, ~0u, 0u);
        list.push_back(item);
      }
    items = gpu::Buffer::of(list);
    selected = gpu::Buffer::of(chosen);
    values = list.size() * kViews * shaders::kApronArea;
    samples = gpu::Buffer(values * 16);
    shaders::SweepParameters parameters{};
    parameters.bricks = {kBricks, kBricks, 1, int(list.size())};
    parameters.axes = {0, 1, 2, 1};
    parameters.layer.x = 3;
    uniforms = gpu::Buffer(sizeof parameters, &parameters);
  }

  gpu::Buffer views_for(const glm::ivec2& size) const {
    std::vector<shaders::GpuView> out;
    for (const GridCamera& camera : cameras) out.push_back(to_gpu_view(camera, size));
    return gpu::Buffer::of(out);
  }

  /// Nanoseconds a sample of a sweep's kernel; `bind` binds the images.
  template <typename Bind>
  double time(gpu::Context& context, const gpu::Program& program, const glm::ivec2& size,
              const Bind& bind) const {
    const gpu::Buffer view_buffer = views_for(size);
    double best = 1e30;
    for (int repeat = 0; repeat < repeats; ++repeat)
      best = std::min(best, seconds_of(context, [&] {
                        bind();
                        uniforms.bind_uniform(shaders::kSweepParametersBinding);
                        view_buffer.bind_storage(shaders::kViewsBinding);
                        items.bind_storage(shaders::kSweepItemsBinding);
                        selected.bind_storage(shaders::kSweepSelectedBinding);
                        samples.bind_storage(shaders::kSweepSamplesBinding);
                        program.dispatch(context, "sweep_rate", std::size_t(kBricks) * kBricks);
                      }));
    return 1e9 * best / double(values);
  }
};

/// Nanoseconds a fetch of a bare loop, at one level for all or at a level of its own each.
template <typename Bind>
double time_raw(gpu::Context& context, int repeats, float lod, float lod_step, const Bind& bind) {
  const auto program = gpu::Program::compute(context, "bench_fetch.comp.glsl");
  const gpu::Buffer sums(std::size_t(kRawThreads) * 16);
  program->set("taps", kRawTaps);
  program->set("layers", kViews);
  program->set("lod", lod);
  program->set("lod_step", lod_step);
  program->set("step_and_size", glm::vec4(1, 0, kWidth, kHeight));
  double best = 1e30;
  for (int repeat = 0; repeat < repeats; ++repeat)
    best = std::min(best, seconds_of(context, [&] {
                      bind();
                      sums.bind_storage(shaders::kFetchSumsBinding);
                      program->dispatch(context, "raw_fetches", kRawThreads / 64);
                    }));
  return 1e9 * best / (double(kRawThreads) * kRawTaps * kViews);
}

}  // namespace

std::vector<SweepRate> measure_sweeps(gpu::Context& context, int repeats, Progress& progress) {
  std::vector<SweepRate> rates;
  const Layer layer(1.0, repeats);
  {
    const ImageSet images(layer.views);
    const auto bind = [&] { images.texture().bind(shaders::kImagesUnit); };
    const glm::ivec2 size(kWidth, kHeight);
    const double raw = time_raw(context, repeats, 0, 0, bind);
    rates.push_back({"bare fetches, 8-bit, one level", 1, raw, 1});
    for (const int n : {1, 2}) {
      const auto program = gpu::Program::compute(context, "projtex_project_layer.comp.glsl",
                                                 concat("#define SUPERSAMPLE ", n, "\n"));
      const double ns = layer.time(context, *program, size, bind) / (n * n);
      rates.push_back({n == 1 ? "mipmap, one level a brick" : "mipmap, one level a brick, 2 x 2", 1,
                       ns, raw / ns});
    }
  }
  // Footprints between two levels, where trilinear filtering reads both.
  const double between = std::exp2(0.4);
  const Layer coarse(between, repeats), coarser(2 * between, repeats);
  for (const Sampler sampler : kSamplers) {
    progress.check_cancelled();
    try {
      const SampleImages images(layer.views, sampler);
      const auto program = images.program(context, "projtex_sample_layer.comp.glsl", 1);
      const auto bind = [&] { images.bind(*program); };
      rates.push_back(
          {to_string(sampler), 1, layer.time(context, *program, images.size(), bind), 0});
      if (sampler == Sampler::kBilinear)
        rates.back().share_of_raw =
            time_raw(context, repeats, 0, 0, bind) / rates.back().nanoseconds;
      if (sampler == Sampler::kBilinear || sampler == Sampler::kAnisotropic)
        rates.push_back(
            {to_string(sampler), between, coarse.time(context, *program, images.size(), bind), 0});
      if (sampler == Sampler::kTrilinear) {
        const double uniform = time_raw(context, repeats, 0.4f, 0, bind);
        const double raw = time_raw(context, repeats, 0.4f, 1e-3f, bind);
        const double ns = coarse.time(context, *program, images.size(), bind);
        rates.push_back({"bare fetches, half float, one pair of levels for all", between, uniform,
                         raw / uniform});
        rates.push_back({"bare fetches, half float, a pair of levels each", between, raw, 1});
        rates.push_back({"trilinear between two levels", between, ns, raw / ns});
        const auto four = images.program(context, "projtex_sample_layer.comp.glsl", 2);
        const double share = coarser.time(context, *four, images.size(), bind) / 4;
        rates.push_back({"trilinear between two levels, 2 x 2", 2 * between, share, raw / share});
      }
    } catch (const Error&) {
      if (sampler != Sampler::kHardware) throw;  // which not every device has
    }
    progress.update(double(rates.size()) / (8.0 + double(std::size(kSamplers))));
  }
  return rates;
}

}  // namespace photohull::projtex
