// Texture samples per second: the sweep's projection kernel beside a bare fetch loop on the same
// images and device, in one run. Counters are per CPU second; divide them for the share of the raw
// rate that the sweep reaches. Run: build/release/bench/sampling_bench
#include <benchmark/benchmark.h>

#include <memory>
#include <random>

#include "gpu/buffer.h"
#include "gpu/context.h"
#include "gpu/program.h"
#include "projtex/gpu_views.h"
#include "projtex/image_set.h"
#include "shared/sweep.h"

namespace {

using namespace photohull;

constexpr int kViews = shaders::kMaxLayerViews;
constexpr int kBricks = 22;  // bricks along each side of the layer

/// Cameras that look along z at a layer whose voxels are about a pixel large.
struct Setup {
  std::unique_ptr<gpu::Context> context = gpu::Context::create("auto");
  std::vector<View> views;
  std::unique_ptr<projtex::ImageSet> images;
  gpu::Buffer view_buffer;

  Setup() {
    std::mt19937 random(1);
    for (int i = 0; i < kViews; ++i) {
      View view;
      view.camera.intrinsics = {640, 480, 600, 600, 0, 320, 240};
      view.camera.cam_from_world.translation = {-88, -88, 600.0 + 20 * i};
      view.image = {640, 480, ColourImage::Encoding::kSrgb8, false, {}};
      view.image.bytes.resize(640 * 480 * 4);
      for (auto& byte : view.image.bytes) byte = std::uint8_t(random());
      views.push_back(std::move(view));
    }
    images = std::make_unique<projtex::ImageSet>(views);
    std::vector<shaders::GpuView> gpu_views;
    const GridSpec grid{{0, 0, 0}, 1.0, {kBricks, kBricks, 1}};
    for (const View& view : views)
      gpu_views.push_back(projtex::to_gpu_view(projtex::to_grid(view.camera, grid), {640, 480}));
    view_buffer = gpu::Buffer::of(gpu_views);
  }
};

Setup& setup() {
  static Setup instance;
  return instance;
}

void raw_fetches(benchmark::State& state) {
  Setup& s = setup();
  constexpr int kTaps = 8, kThreads = 1 << 18;
  const gpu::Program program = gpu::Program::compute("bench_fetch.comp.glsl");
  const gpu::Buffer sums(std::size_t(kThreads) * 16);
  program.set("taps", kTaps);
  program.set("layers", kViews);
  program.set("lod", 0.4f);
  program.set("lod_step", 0.0f);
  program.set("step_and_size", glm::vec4(1, 0, 640, 480));
  for (auto _ : state) {
    s.images->texture().bind(0);
    sums.bind_storage(0);
    program.dispatch(*s.context, "raw_fetches", kThreads / 64);
  }
  state.counters["samples"] = benchmark::Counter(
      double(state.iterations()) * kTaps * kViews * kThreads, benchmark::Counter::kIsRate);
}

void sweep_projection(benchmark::State& state) {
  Setup& s = setup();
  const int n = int(state.range(0));
  const gpu::Program program = gpu::Program::compute(
      "projtex_project_layer.comp.glsl", "#define SUPERSAMPLE " + std::to_string(n) + "\n");
  std::vector<shaders::LayerItem> items;
  std::vector<glm::uvec4> selected(1);
  for (int y = 0; y < kBricks; ++y)
    for (int x = 0; x < kBricks; ++x) {
      shaders::LayerItem item{};
      item.brick = {x, y, 0, kViews};
      for (int v = 0; v < kViews; ++v) item.views[v / 4][v % 4] = unsigned(v);
      selected.emplace_back(unsigned(items.size()), ~0u, ~0u, 0u);
      items.push_back(item);
    }
  const gpu::Buffer item_buffer = gpu::Buffer::of(items), list = gpu::Buffer::of(selected);
  const std::size_t values = items.size() * kViews * shaders::kApronArea;
  const gpu::Buffer samples(values * 16);
  shaders::SweepParameters parameters{};
  parameters.bricks = {kBricks, kBricks, 1, int(items.size())};
  parameters.axes = {0, 1, 2, 1};
  parameters.layer.x = 3;
  const gpu::Buffer uniforms(sizeof parameters, &parameters);
  for (auto _ : state) {
    s.images->texture().bind(0);
    uniforms.bind_uniform(0);
    s.view_buffer.bind_storage(0);
    item_buffer.bind_storage(1);
    list.bind_storage(5);
    samples.bind_storage(6);
    program.dispatch(*s.context, "sweep_projection", items.size());
  }
  state.counters["samples"] = benchmark::Counter(
      double(state.iterations()) * double(values) * n * n, benchmark::Counter::kIsRate);
}

BENCHMARK(raw_fetches)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);
BENCHMARK(sweep_projection)->Arg(1)->Arg(2)->MeasureProcessCPUTime()->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();
