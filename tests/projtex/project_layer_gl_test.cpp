// The kernel that projects photographs onto reference planes against its reference.
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/texture.h"
#include "projtex/project_layer_reference.h"
#include "shared/sweep.h"
#include "support/filtering.h"
#include "support/gl_context.h"
#include "support/ray_cast.h"

namespace photohull::projtex {
namespace {

using glm::ivec3;
using reference::LinearImage;
using reference::MipFilter;
using reference::PlaneSquare;

struct LayerCase {
  GridSpec grid{{-12, -8, -8}, 1, {3, 2, 2}};
  int axis = 2, sign = 1, layer = 3;
  int supersample = 1;
  bool front_face = false;
  MipFilter filter = MipFilter::kNearest;
};

/// What a run of the kernel met.
struct Outcome {
  double worst = 0;       ///< greatest difference of a colour or alpha
  int compared = 0;       ///< samples on the image
  int off_image = 0;      ///< samples that both call not shown
  int disagreements = 0;  ///< samples that only one of both calls shown
};

class ProjectLayer : public ::testing::Test {
 protected:
  static constexpr int kSize = 128;

  void TearDown() override { context_.check_errors("project layer test"); }

  void load(const std::vector<ColourImage>& images, MipFilter filter) {
    const bool half = images[0].encoding == ColourImage::Encoding::kLinearHalf;
    texture_ =
        gpu::TextureArray(half ? gpu::TextureFormat::kRgba16f : gpu::TextureFormat::kSrgb8Alpha8,
                          kSize, kSize, int(images.size()), 0);
    for (std::size_t i = 0; i < images.size(); ++i)
      texture_.upload(int(i), kSize, kSize, images[i].bytes.data());
    texture_.generate_mipmaps();
    texture_.set_filter(filter == MipFilter::kTrilinear);
    mips_.clear();
    for (const ColourImage& image : images)
      mips_.push_back(reference::mip_chain(image, {kSize, kSize}));
  }

  /// All bricks of the layer's slab, each with all the cameras (at most kMaxLayerViews).
  std::vector<shaders::LayerItem> items_of(const LayerCase& layer_case, int views) const {
    const ivec3 bricks = layer_case.grid.bricks;
    const int u = (layer_case.axis + 1) % 3, v = (layer_case.axis + 2) % 3;
    std::vector<shaders::LayerItem> items;
    ivec3 brick;
    brick[layer_case.axis] = voxel_along(layer_case, layer_case.layer) / kBrickEdge;
    for (brick[v] = 0; brick[v] < bricks[v]; ++brick[v])
      for (brick[u] = 0; brick[u] < bricks[u]; ++brick[u]) {
        shaders::LayerItem item{};
        item.brick = glm::ivec4(brick, views);
        for (int i = 0; i < views; ++i) item.views[i / 4][i % 4] = unsigned(i);
        items.push_back(item);
      }
    return items;
  }

  static int voxel_along(const LayerCase& layer_case, int layer) {
    return layer_case.sign > 0 ? layer : layer_case.grid.voxels()[layer_case.axis] - 1 - layer;
  }

  std::vector<glm::vec4> run(const LayerCase& layer_case, const std::vector<GridCamera>& cameras,
                             const std::vector<shaders::LayerItem>& items) {
    std::vector<shaders::GpuView> views;
    for (const GridCamera& c : cameras) views.push_back(to_gpu_view(c, {kSize, kSize}));
    shaders::SweepParameters parameters{};
    parameters.bricks = glm::ivec4(layer_case.grid.bricks, int(items.size()));
    parameters.axes = {(layer_case.axis + 1) % 3, (layer_case.axis + 2) % 3, layer_case.axis,
                       layer_case.sign};
    parameters.layer = {layer_case.layer, 0, 0, layer_case.front_face};
    std::vector<glm::uvec4> selected{{unsigned(items.size()), 0, 0, 0}};
    for (std::size_t i = 0; i < items.size(); ++i) selected.emplace_back(unsigned(i), ~0u, ~0u, 0u);
    const std::size_t count = items.size() * shaders::kMaxLayerViews * shaders::kApronArea;
    const gpu::Buffer parameter_buffer(sizeof parameters, &parameters);
    const gpu::Buffer view_buffer = gpu::Buffer::of(views), item_buffer = gpu::Buffer::of(items);
    const gpu::Buffer selected_buffer = gpu::Buffer::of(selected), samples(count * 16);
    parameter_buffer.bind_uniform(shaders::kSweepParametersBinding);
    view_buffer.bind_storage(shaders::kViewsBinding);
    item_buffer.bind_storage(shaders::kSweepItemsBinding);
    selected_buffer.bind_storage(shaders::kSweepSelectedBinding);
    samples.bind_storage(shaders::kSweepSamplesBinding);
    texture_.bind(shaders::kImagesUnit);
    gpu::Program::compute(context_, "projtex_project_layer.comp.glsl",
                          concat("#define SUPERSAMPLE ", layer_case.supersample, "\n"))
        ->dispatch(context_, "projtex_project_layer", items.size());
    return samples.download<glm::vec4>(count);
  }

  /// The square of a place in the item's apron (x along u, y along v).
  static PlaneSquare square_of(const LayerCase& layer_case, const shaders::LayerItem& item,
                               const glm::dvec2& place) {
    const int u = (layer_case.axis + 1) % 3, v = (layer_case.axis + 2) % 3;
    PlaneSquare square;
    square.u[u] = square.v[v] = 1;
    square.centre[u] = item.brick[u] * kBrickEdge - shaders::kPatchRadius + place.x;
    square.centre[v] = item.brick[v] * kBrickEdge - shaders::kPatchRadius + place.y;
    square.centre[layer_case.axis] = voxel_along(layer_case, layer_case.layer) -
                                     (layer_case.front_face ? 0.5 * layer_case.sign : 0.0);
    return square;
  }

  /// Is single precision free to differ: at the border or the plane of the camera?
  static bool near_border(const GridCamera& camera, const PlaneSquare& square) {
    const glm::dvec3 p = camera.projection * glm::dvec4(square.centre, 1);
    if (std::abs(p.z) < 1e-2) return true;
    const glm::dvec2 pixel = glm::dvec2(p) / p.z;
    const double bound = 1e-3;
    for (int i = 0; i < 2; ++i)
      if (std::abs(pixel[i] + 0.5) < bound || std::abs(pixel[i] - kSize + 0.5) < bound) return true;
    return false;
  }

  /// Is `lambda` at a switch of the nearest level?
  static bool at_switch(const LayerCase& layer_case, double lambda) {
    return layer_case.filter == MipFilter::kNearest &&
           std::abs(lambda - std::floor(lambda) - 0.5) < 1e-4;
  }

  Outcome compare(const LayerCase& layer_case, const std::vector<GridCamera>& cameras) {
    const auto items = items_of(layer_case, int(cameras.size()));
    const std::vector<glm::vec4> samples = run(layer_case, cameras, items);
    Outcome out;
    for (std::size_t i = 0; i < items.size(); ++i)
      for (std::size_t view = 0; view < cameras.size(); ++view) {
        const glm::dvec2 middle(0.5 * (shaders::kApronEdge - 1));
        const double lambda = mip_level(cameras[view], square_of(layer_case, items[i], middle),
                                        layer_case.supersample);
        if (at_switch(layer_case, lambda)) continue;
        for (int a = 0; a < shaders::kApronArea; ++a) {
          const glm::dvec2 place(a % shaders::kApronEdge, a / shaders::kApronEdge);
          const PlaneSquare square = square_of(layer_case, items[i], place);
          if (near_border(cameras[view], square)) continue;
          const glm::dvec4 expected =
              reference::project_layer_sample(cameras[view], mips_[view], square,
                                              layer_case.supersample, lambda, layer_case.filter);
          const glm::dvec4 found(
              samples[(i * shaders::kMaxLayerViews + view) * shaders::kApronArea + a]);
          if ((expected.a < 0) != (found.a < 0)) {
            ++out.disagreements;
          } else if (expected.a < 0) {
            ++out.off_image;
          } else {
            ++out.compared;
            const glm::dvec4 d = glm::abs(expected - found);
            out.worst = std::max({out.worst, d.r, d.g, d.b, d.a});
          }
        }
      }
    return out;
  }

  /// Random axes, layers, supersampling and cameras, whose focal lengths are 2^low_zoom to
  /// 2^high_zoom of what fills the image; returns the sums and the worst of all.
  Outcome compare_random(int trials, MipFilter filter, double low_zoom, double high_zoom) {
    Outcome all;
    for (int trial = 0; trial < trials; ++trial) {
      LayerCase layer_case;
      layer_case.filter = filter;
      layer_case.axis = trial % 3;
      layer_case.sign = trial % 2 ? 1 : -1;
      layer_case.layer = trial * 5 % layer_case.grid.voxels()[layer_case.axis];
      layer_case.supersample = 1 + trial % 3;
      layer_case.front_face = trial % 4 == 0;
      std::vector<GridCamera> cameras;
      for (std::size_t i = 0; i < mips_.size(); ++i) {
        Camera camera = test::random_camera(rng_, layer_case.grid.bounds(), kSize, kSize);
        const double zoom = std::pow(2.0, test::uniform(rng_, low_zoom, high_zoom));
        camera.intrinsics.fx *= zoom;
        camera.intrinsics.fy *= zoom;
        camera.intrinsics.skew *= zoom;
        cameras.push_back(to_grid(camera, layer_case.grid));
      }
      const Outcome one = compare(layer_case, cameras);
      all.worst = std::max(all.worst, one.worst);
      all.compared += one.compared;
      all.off_image += one.off_image;
      all.disagreements += one.disagreements;
    }
    return all;
  }

  std::vector<ColourImage> random_images(int count) {
    std::vector<ColourImage> images;
    for (int i = 0; i < count; ++i) images.push_back(test::random_image(rng_, kSize, kSize));
    return images;
  }

  static std::vector<ColourImage> as_half(std::vector<ColourImage> images) {
    for (ColourImage& image : images) image = test::to_half(image);
    return images;
  }

  gpu::Context& context_ = test::gl_context();
  test::Rng rng_{11};
  gpu::TextureArray texture_;
  std::vector<std::vector<LinearImage>> mips_;
};

/// Beyond what a device without rounding of weights may be off by: square roots of linear light,
/// which are compared, magnify what is rounded in the dark.
double bound_beyond(double exact) { return exact + 12 * test::filtering_error(); }
// Measured on llvmpipe: 5e-4 of full scale with half floats, whose levels are exact to 2^-11.
double bound() { return bound_beyond(1e-3); }
// llvmpipe decodes 8-bit sRGB by a polynomial that is off by up to 1.2e-3.
double bound_8_bit() { return bound_beyond(2e-3); }
// 8-bit images round every mip level to a step of sRGB, up to 3.9e-3; measured: 4.9e-3.
double bound_8_bit_mips() { return bound_beyond(6e-3); }

TEST_F(ProjectLayer, HalfFloatImagesNearestLevel) {
  load(as_half(random_images(8)), MipFilter::kNearest);
  const Outcome found = compare_random(12, MipFilter::kNearest, -3.5, 1.5);
  EXPECT_LT(found.worst, bound());
  EXPECT_EQ(found.disagreements, 0);
  EXPECT_GT(found.compared, 50000);
  EXPECT_GT(found.off_image, 1000);
}

TEST_F(ProjectLayer, HalfFloatImagesTrilinear) {
  load(as_half(random_images(8)), MipFilter::kTrilinear);
  const Outcome found = compare_random(12, MipFilter::kTrilinear, -3.5, 1.5);
  EXPECT_LT(found.worst, bound());
  EXPECT_EQ(found.disagreements, 0);
}

TEST_F(ProjectLayer, EightBitImagesAtLevelZero) {
  load(random_images(8), MipFilter::kNearest);
  const Outcome found = compare_random(6, MipFilter::kNearest, -5, -3.5);
  EXPECT_LT(found.worst, bound_8_bit());
  EXPECT_EQ(found.disagreements, 0);
  EXPECT_GT(found.compared, 10000);
}

TEST_F(ProjectLayer, EightBitImagesWithMipLevels) {
  load(random_images(8), MipFilter::kNearest);
  const Outcome found = compare_random(12, MipFilter::kNearest, -3.5, 1.5);
  EXPECT_LT(found.worst, bound_8_bit_mips());
  EXPECT_EQ(found.disagreements, 0);
}

TEST_F(ProjectLayer, PlanesEdgeOnToTheCamera) {
  load(as_half(random_images(2)), MipFilter::kNearest);
  LayerCase layer_case;
  const GridSpec& grid = layer_case.grid;
  // The optical centre lies in the plane, or a hundredth of a voxel off it.
  for (const double off : {0.0, 0.01}) {
    const glm::dvec3 eye = grid.world({-30, 6, layer_case.layer + off});
    const glm::dvec3 target = grid.world({12, 8, layer_case.layer});
    std::vector<GridCamera> cameras;
    for (const double focal : {100.0, 400.0})
      cameras.push_back(to_grid(test::look_at(eye, target, focal, kSize, kSize), grid));
    const Outcome found = compare(layer_case, cameras);
    EXPECT_LT(found.worst, bound());
    EXPECT_EQ(found.disagreements, 0);
    EXPECT_GT(found.compared, 100);
  }
}

TEST_F(ProjectLayer, CamerasWithinThePlane) {
  // The camera's own plane cuts the bricks: part of them is behind, and depths come close to zero.
  load(as_half(random_images(4)), MipFilter::kNearest);
  LayerCase layer_case;
  std::vector<GridCamera> cameras;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3 eye = layer_case.grid.world({9.3 + i, 7.6, layer_case.layer - 0.4 * i});
    const glm::dvec3 target = layer_case.grid.world({20, 3 * i, layer_case.layer + 2});
    cameras.push_back(to_grid(test::look_at(eye, target, 40, kSize, kSize), layer_case.grid));
  }
  const Outcome found = compare(layer_case, cameras);
  EXPECT_LT(found.worst, bound());
  EXPECT_EQ(found.disagreements, 0);
  EXPECT_GT(found.compared, 100);
  EXPECT_GT(found.off_image, 100);
}

TEST_F(ProjectLayer, NothingBehindTheCameraIsShown) {
  load(as_half(random_images(1)), MipFilter::kNearest);
  LayerCase layer_case;
  const Camera away = test::look_at({0, 0, -40}, {0, 0, -80}, 100, kSize, kSize);
  const Outcome found = compare(layer_case, {to_grid(away, layer_case.grid)});
  EXPECT_EQ(found.compared + found.disagreements, 0);
  EXPECT_GT(found.off_image, 0);
}

TEST_F(ProjectLayer, TheImageEndsAtItsBorder) {
  load(as_half(random_images(1)), MipFilter::kNearest);
  LayerCase layer_case;
  const Camera camera = test::look_at({0, 0, -40}, {12, 0, 0}, 300, kSize, kSize);
  const Outcome found = compare(layer_case, {to_grid(camera, layer_case.grid)});
  EXPECT_LT(found.worst, bound());
  EXPECT_EQ(found.disagreements, 0);
  EXPECT_GT(found.compared, 50);
  EXPECT_GT(found.off_image, 50);
}

TEST_F(ProjectLayer, ItemsWithoutViewsAndEmptySelectionsAreNoWork) {
  load(as_half(random_images(1)), MipFilter::kNearest);
  EXPECT_EQ(compare(LayerCase{}, {}).compared, 0);
  EXPECT_TRUE(run(LayerCase{}, {}, {}).empty());
}

}  // namespace
}  // namespace photohull::projtex
