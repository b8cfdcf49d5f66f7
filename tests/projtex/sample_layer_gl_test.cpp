// The sweep's kernel with any sampler, on planes through voxels' centres and front faces.
#include <gtest/gtest.h>

#include "gpu/buffer.h"
#include "projtex/sample_images.h"
#include "projtex/sampler_reference.h"
#include "shared/sampling.h"
#include "shared/sweep.h"
#include "support/filtering.h"
#include "support/gl_context.h"
#include "support/ray_cast.h"

namespace photohull::projtex {
namespace {

using reference::PlaneSquare;

struct LayerCase {
  int axis = 2, sign = 1, layer = 3;
  bool front_face = false;
  int supersample = 1;
  bool search = false;  ///< at three offsets, of which kOffset is the second
};

const glm::dvec2 kOffset{1.25, -0.75};
constexpr const char* kSearch =
    "#define SEARCH_TAPS 3\n"
    "#define SEARCH_OFFSETS vec2(0.0), vec2(1.25, -0.75), vec2(40.0, 0.0)\n";

class SampleLayer : public ::testing::Test {
 protected:
  static constexpr int kViews = 3, kSize = 100;
  const GridSpec grid_{{-8, -8, -8}, 1, {2, 2, 2}};

  SampleLayer() {
    for (int i = 0; i < kViews; ++i) {
      PreparedView view;
      view.camera = test::random_camera(rng_, grid_.bounds(), kSize, kSize);
      view.image = test::to_half(test::random_image(rng_, kSize, kSize));
      views_.push_back(view);
    }
  }
  void TearDown() override { context_.check_errors("sample layer test"); }

  /// The square of a place in a brick's apron.
  PlaneSquare square_of(const LayerCase& c, const glm::ivec3& brick, int place, bool centre) const {
    const int u = (c.axis + 1) % 3, v = (c.axis + 2) % 3;
    PlaneSquare square;
    square.u[u] = square.v[v] = 1;
    square.centre[u] = brick[u] * kBrickEdge - shaders::kPatchRadius + place % shaders::kApronEdge;
    square.centre[v] = brick[v] * kBrickEdge - shaders::kPatchRadius + place / shaders::kApronEdge;
    square.centre[c.axis] = (c.sign > 0 ? c.layer : grid_.voxels()[c.axis] - 1 - c.layer) -
                            (c.front_face && !centre ? 0.5 * c.sign : 0.0);
    return square;
  }

  void compare(Sampler sampler, const LayerCase& c) {
    const SampleImages images(views_, sampler);
    std::vector<shaders::GpuView> gpu_views;
    std::vector<GridCamera> cameras;
    std::vector<std::vector<reference::LinearImage>> chains;
    for (const PreparedView& view : views_) {
      cameras.push_back(to_grid(view.camera, grid_));
      gpu_views.push_back(to_gpu_view(cameras.back(), images.size()));
      // Elsewhere on the image is where a camera with another principal point has it.
      Camera moved = view.camera;
      if (c.search) moved.intrinsics.cx += kOffset.x, moved.intrinsics.cy += kOffset.y;
      cameras.back() = to_grid(moved, grid_);
      chains.push_back(
          reference::covered_chain(reference::covered_image(view.image, view.mask, images.size())));
    }
    shaders::LayerItem item{};
    item.brick = {1, 0, 1, kViews};
    item.brick[c.axis] = (c.sign > 0 ? c.layer : grid_.voxels()[c.axis] - 1 - c.layer) / kBrickEdge;
    for (int i = 0; i < kViews; ++i) item.views[i / 4][i % 4] = unsigned(i);
    shaders::SweepParameters parameters{};
    parameters.bricks = glm::ivec4(grid_.bricks, 1);
    parameters.axes = {(c.axis + 1) % 3, (c.axis + 2) % 3, c.axis, c.sign};
    parameters.layer = {c.layer, 0, 0, c.front_face};
    const gpu::Buffer uniforms(sizeof parameters, &parameters);
    const gpu::Buffer view_buffer = gpu::Buffer::of(gpu_views);
    const gpu::Buffer items = gpu::Buffer::of(std::vector<shaders::LayerItem>{item});
    const gpu::Buffer selected =
        gpu::Buffer::of(std::vector<glm::uvec4>{{1, 0, 0, 0}, {0, ~0u, ~0u, 0}});
    const std::size_t offsets = c.search ? 3 : 1;
    const std::size_t count = shaders::kMaxLayerViews * offsets * shaders::kApronArea;
    const gpu::Buffer samples(count * 16);
    uniforms.bind_uniform(shaders::kSweepParametersBinding);
    view_buffer.bind_storage(shaders::kViewsBinding);
    items.bind_storage(shaders::kSweepItemsBinding);
    selected.bind_storage(shaders::kSweepSelectedBinding);
    samples.bind_storage(shaders::kSweepSamplesBinding);
    const auto program = images.program(context_, "projtex_sample_layer.comp.glsl", c.supersample,
                                        c.search ? kSearch : "");
    images.bind(*program);
    program->dispatch(context_, "projtex_sample_layer", 1, offsets);
    const auto found = samples.download<glm::vec4>(count);
    for (int view = 0; view < kViews; ++view)
      for (int place = 0; place < shaders::kApronArea; ++place) {
        const PlaneSquare square =
            square_of(c, glm::ivec3(item.brick), place, sampler == Sampler::kCentroid);
        const reference::Footprint f = reference::footprint_of(cameras[view], square);
        const glm::dvec2 off = glm::abs(f.pixel + 0.5 - glm::round(f.pixel + 0.5));
        if (std::min(off.x, off.y) < 1e-3) continue;  // between two pixels
        const glm::dvec4 expected = reference::resolved(
            reference::sample_square(sampler, chains[view], cameras[view], square, c.supersample));
        const glm::dvec4 sample(
            found[(std::size_t(view) * offsets + offsets / 2) * shaders::kApronArea + place]);
        const bool on_image = f.in_front && f.pixel.x > -0.5 && f.pixel.y > -0.5 &&
                              f.pixel.x < kSize - 0.5 && f.pixel.y < kSize - 0.5;
        if (expected.a < shaders::kLeastCoverage) {
          EXPECT_EQ(sample.a, on_image ? 0 : -1);
          continue;
        }
        ++compared_;
        EXPECT_LT(glm::length(sample - expected), 1e-3 + 3 * test::filtering_error())
            << to_string(sampler) << ", " << place;
      }
  }

  gpu::Context& context_ = test::gl_context();
  test::Rng rng_{31};
  std::vector<PreparedView> views_;
  int compared_ = 0;
};

TEST_F(SampleLayer, CentresAndFrontFacesAlongAllAxes) {
  for (const Sampler sampler : {Sampler::kNearest, Sampler::kTrilinear, Sampler::kSummedArea})
    for (int axis = 0; axis < 3; ++axis)
      for (const bool front_face : {false, true})
        compare(sampler, {axis, axis == 1 ? -1 : 1, 3 + axis, front_face, 1 + axis % 2});
  EXPECT_GT(compared_, 4000);
}

TEST_F(SampleLayer, ImageSpaceTakesTheVoxelsCentreWhateverThePlane) {
  compare(Sampler::kCentroid, {2, 1, 5, true, 1});
  EXPECT_GT(compared_, 200);
}

TEST_F(SampleLayer, OffsetsOfASearch) {
  for (const Sampler sampler : {Sampler::kTrilinear, Sampler::kAnisotropic})
    compare(sampler, {2, 1, 3, false, 1, true});
  EXPECT_GT(compared_, 400);
}

}  // namespace
}  // namespace photohull::projtex
