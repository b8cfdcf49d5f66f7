#include "carving/fit_grid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/error.h"
#include "support/cameras.h"

namespace photohull::carving {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
const Box kBox{{1, 2, 3}, {2, 4, 3.5}};

TEST(FitGrid, CentresTheBoxWithAMarginOfThreeVoxels) {
  test::Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    Box box;
    box.min = 100.0 * test::random_direction(rng);
    box.max = box.min + glm::dvec3(test::uniform(rng, 0.1, 3), test::uniform(rng, 0.1, 3),
                                   test::uniform(rng, 0.1, 3));
    const double voxel = test::uniform(rng, 0.02, 0.5);
    const GridSpec grid = fit_grid(box, voxel);
    EXPECT_EQ(grid.voxel_size, voxel);
    const Box bounds = grid.bounds();
    EXPECT_NEAR(glm::distance(bounds.center(), box.center()), 0, 1e-9);
    for (int axis = 0; axis < 3; ++axis) {
      const double margin = (box.min[axis] - bounds.min[axis]) / voxel;
      EXPECT_GE(margin, 3 - 1e-9);
      EXPECT_LT(margin, 3 + 0.5 * kBrickEdge);
    }
  }
}

TEST(FitGrid, AFlatBoxStillHasVoxels) {
  const GridSpec grid = fit_grid({{0, 0, 0}, {1, 1, 0}}, 0.1);
  EXPECT_EQ(grid.bricks, glm::ivec3(2, 2, 1));
}

TEST(FitGrid, RefusesVoxelSizesThatMeanNothing) {
  for (const double size : {0.0, -1.0, kNan, kInfinity, -kInfinity})
    EXPECT_THROW(fit_grid(kBox, size), UsageError) << size;
  // A box without extent has no voxel size of its own.
  EXPECT_THROW(fit_grid({{1, 1, 1}, {1, 1, 1}}, voxel_size_for({{1, 1, 1}, {1, 1, 1}}, 100)),
               UsageError);
}

TEST(FitGrid, RefusesBoxesWithoutFiniteCorners) {
  EXPECT_THROW(fit_grid({{0, 0, 0}, {1, kNan, 1}}, 0.1), Error);
  EXPECT_THROW(fit_grid({{kNan, 0, 0}, {1, 1, 1}}, 0.1), Error);
  EXPECT_THROW(fit_grid({{0, 0, 0}, {1, 1, kInfinity}}, 0.1), Error);
}

TEST(FitGrid, RefusesAbsurdResolutionsWithTheMemoryTheyWouldTake) {
  const Box cube{{0, 0, 0}, {1, 1, 1}};
  try {
    fit_grid(cube, voxel_size_for(cube, 1000000));
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), ErrorKind::kFailed);
    EXPECT_THAT(e.what(), ::testing::HasSubstr("MiB"));
    EXPECT_THAT(e.what(), ::testing::HasSubstr("lower resolution"));
  }
  EXPECT_THROW(fit_grid(cube, 1e-300), Error);
  EXPECT_NO_THROW(fit_grid(cube, voxel_size_for(cube, 3000)));
}

TEST(VoxelSizeFor, DividesTheLongestSide) {
  EXPECT_DOUBLE_EQ(voxel_size_for(kBox, 100), 0.02);
  for (const int resolution : {1, 0, -5})
    EXPECT_THROW(voxel_size_for(kBox, resolution), UsageError) << resolution;
}

TEST(PixelFootprint, IsTheMedianOfDepthOverFocalLength) {
  std::vector<Camera> cameras;
  for (const double depth : {4.0, 2.0, 8.0})
    cameras.push_back(
        test::look_at(kBox.center() - glm::dvec3(0, depth, 0), kBox.center(), 100, 64, 48));
  EXPECT_NEAR(pixel_footprint(kBox, cameras), 0.04, 1e-12);
  // One that looks away does not count.
  cameras.push_back(test::look_at({0, -100, 0}, {0, -200, 0}, 1, 64, 48));
  EXPECT_NEAR(pixel_footprint(kBox, cameras), 0.04, 1e-12);
  EXPECT_EQ(pixel_footprint(kBox, {}), 0);
}

}  // namespace
}  // namespace photohull::carving
