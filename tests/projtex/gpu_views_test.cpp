#include "projtex/gpu_views.h"

#include <gtest/gtest.h>

#include "support/cameras.h"

namespace photohull::projtex {
namespace {

struct Scene {
  const char* name;
  double size;  ///< world units along the box
  double away;  ///< diagonals from the world's origin
  double pixel_bound;
};

class ToGrid : public ::testing::TestWithParam<Scene> {
 protected:
  /// A grid of 512 voxels along x.
  GridSpec grid() const {
    const double size = GetParam().size;
    return {glm::dvec3(1, -2, 0.5) * (GetParam().away * size), size / 512, {64, 48, 32}};
  }
};

TEST_P(ToGrid, ProjectsVoxelsAsTheCameraDoes) {
  test::Rng rng(1);
  const GridSpec grid = this->grid();
  const Box voxels{glm::dvec3(-0.5), glm::dvec3(grid.voxels()) - 0.5};
  for (int i = 0; i < 500; ++i) {
    const Camera camera = test::random_camera(rng, grid.bounds(), 1024, 768);
    const GridCamera in_grid = to_grid(camera, grid);
    const glm::dvec3 voxel = test::uniform_in(rng, voxels), world = grid.world(voxel);
    const auto pixel = camera.project(world);
    ASSERT_TRUE(pixel);
    const glm::dvec3 stq = in_grid.projection * glm::dvec4(voxel, 1);
    EXPECT_LT(glm::distance(glm::dvec2(stq) / stq.z, *pixel), GetParam().pixel_bound);
    EXPECT_NEAR(stq.z * grid.voxel_size / camera.to_camera(world).z, 1, 1e-9);
    EXPECT_LT(glm::distance(grid.world(in_grid.centre), camera.center()),
              1e-10 * GetParam().size * (1 + GetParam().away));
    EXPECT_NEAR(in_grid.focal, std::sqrt(camera.intrinsics.fx * camera.intrinsics.fy), 1e-9);
  }
}

TEST_P(ToGrid, SinglePrecisionStaysWithinAHundredthOfAPixel) {
  test::Rng rng(2);
  const GridSpec grid = this->grid();
  const Box voxels{glm::dvec3(-0.5), glm::dvec3(grid.voxels()) - 0.5};
  double worst = 0;
  for (int i = 0; i < 2000; ++i) {
    const GridCamera camera = to_grid(test::random_camera(rng, grid.bounds(), 1024, 768), grid);
    const shaders::GpuView view = to_gpu_view(camera, {1024, 768});
    const glm::dvec3 voxel = test::uniform_in(rng, voxels);
    const glm::vec4 p(glm::vec3(voxel), 1.0f);
    const float q = glm::dot(view.row_q, p);
    const glm::vec2 pixel(glm::dot(view.row_s, p) / q, glm::dot(view.row_t, p) / q);
    const glm::dvec3 exact = camera.projection * glm::dvec4(voxel, 1);
    worst = std::max(worst, glm::distance(glm::dvec2(pixel), glm::dvec2(exact) / exact.z));
  }
  EXPECT_LT(worst, 1e-2);
  RecordProperty("worst_pixels", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ToGrid,
                         ::testing::Values(Scene{"Metre", 1, 1, 1e-9}, Scene{"Huge", 1e7, 1, 1e-9},
                                           Scene{"Tiny", 1e-7, 1, 1e-9},
                                           Scene{"FarFromTheOrigin", 1, 1e5, 1e-5}),
                         [](const auto& scene) { return scene.param.name; });

TEST(ToGpuView, CarriesSizesAndReciprocals) {
  test::Rng rng(3);
  const GridSpec grid{{0, 0, 0}, 1, {1, 1, 1}};
  const GridCamera camera = to_grid(test::random_camera(rng, grid.bounds(), 100, 80), grid);
  const shaders::GpuView view = to_gpu_view(camera, {128, 96});
  EXPECT_EQ(view.size, glm::vec4(100, 80, 1 / 128.0f, 1 / 96.0f));
  EXPECT_EQ(view.centre.w, float(camera.focal));
}

TEST(ArraySize, HoldsEveryImage) {
  std::vector<Camera> cameras(2);
  cameras[0].intrinsics.width = 100;
  cameras[0].intrinsics.height = 20;
  cameras[1].intrinsics.width = 30;
  cameras[1].intrinsics.height = 200;
  EXPECT_EQ(array_size(cameras), glm::ivec2(100, 200));
  EXPECT_EQ(array_size({}), glm::ivec2(1));
}

}  // namespace
}  // namespace photohull::projtex
