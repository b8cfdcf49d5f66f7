// The depth-map references against cases that can be worked out by hand.
#include <gtest/gtest.h>

#include <limits>

#include "visibility/kernels/depth_maps.h"

namespace photohull::visibility::reference {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// 8 x 6 pixels, one texel each; looks along z so that at depth 10 a voxel is one pixel and voxel
/// (x, y, 10) lies at pixel (x, y).
projtex::GridCamera frontal_camera() {
  projtex::GridCamera camera;
  camera.projection =
      glm::dmat4x3(glm::dvec3(10, 0, 0), glm::dvec3(0, 10, 0), glm::dvec3(0, 0, 1), glm::dvec3(0));
  camera.focal = 10;
  camera.width = 8;
  camera.height = 6;
  return camera;
}

class DepthMap : public ::testing::Test {
 protected:
  void splat(const glm::ivec3& voxel) { splat_voxel(camera_, info_, voxel, depths_); }
  bool sees(const glm::dvec3& point, double bias = 0.5) const {
    return visible(camera_, info_, point, bias, depths_);
  }
  int drawn() const {
    int count = 0;
    for (const double d : depths_) count += d < kInfinity;
    return count;
  }

  projtex::GridCamera camera_ = frontal_camera();
  shaders::DepthMapInfo info_{{8, 6, 0, 0}, {1, 0, 0, 0}};
  std::vector<double> depths_ = std::vector<double>(48, kInfinity);
};

TEST_F(DepthMap, AVoxelCoversTheTexelsItTouches) {
  // At depth 5 a voxel is two pixels wide: from pixel 3 to 5 around pixel 4.
  splat({2, 1, 5});
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) {
      const bool touched = x >= 3 && x <= 5 && y >= 1 && y <= 3;
      EXPECT_EQ(depths_[y * 8 + x], touched ? 5 : kInfinity) << x << ", " << y;
    }
}

TEST_F(DepthMap, TheNearestVoxelCounts) {
  splat({4, 2, 20});
  splat({2, 1, 10});
  splat({4, 2, 20});
  EXPECT_EQ(depths_[1 * 8 + 2], 10);
}

TEST_F(DepthMap, VoxelsBehindOrAtTheCameraAreLeftOut) {
  splat({0, 0, -10});
  splat({0, 0, 0});
  splat({0, 0, 1});
  EXPECT_EQ(drawn(), 0);
}

TEST_F(DepthMap, VoxelsOffTheMapAreLeftOut) {
  splat({-3, 2, 10});
  splat({9, 2, 10});
  splat({2, -3, 10});
  splat({2, 8, 10});
  EXPECT_EQ(drawn(), 0);
  splat({-1, 2, 10});  // ends where the first texel begins
  EXPECT_GT(drawn(), 0);
}

TEST_F(DepthMap, HidesWhatLiesBehindByMoreThanTheBias) {
  splat({2, 1, 10});
  EXPECT_TRUE(sees({2, 1, 10}));
  EXPECT_TRUE(sees({2.1, 1.05, 10.5}));
  EXPECT_FALSE(sees({2.2, 1.1, 11}));
  EXPECT_TRUE(sees({2.2, 1.1, 11}, 1.5));
  EXPECT_TRUE(sees({8, 4, 20}));  // in front of an empty texel
  EXPECT_TRUE(sees({1, 0.5, 5}));
}

}  // namespace
}  // namespace photohull::visibility::reference
