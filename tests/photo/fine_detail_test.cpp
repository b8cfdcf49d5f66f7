#include "photo/fine_detail.h"

#include <gtest/gtest.h>

#include <cmath>

namespace photohull {
namespace {

/// Waves of several lengths and directions, moved while the picture was taken.
GreyImage waves(double contrast, double movement) {
  GreyImage image{160, 120, {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      double sum = 0;
      constexpr int kSteps = 16;
      for (int i = 0; i < kSteps; ++i) {
        const double u = x + movement * (i + 0.5) / kSteps;
        sum += std::sin(1.3 * u + 0.4 * y) + std::sin(0.5 * u - 0.7 * y) +
               std::sin(0.11 * u + 0.17 * y);
      }
      image.values.push_back(float(128 + contrast * sum / kSteps));
    }
  return image;
}

TEST(FineDetail, FallsWithMotionBlurAndNotWithContrast) {
  const double sharp = fine_detail(waves(30, 0));
  EXPECT_NEAR(fine_detail(waves(10, 0)) / sharp, 1, 0.01);
  EXPECT_LT(fine_detail(waves(30, 3)), 0.9 * sharp);
  EXPECT_LT(fine_detail(waves(30, 6)), 0.7 * sharp);
}

TEST(FineDetail, IsNothingWithoutTexture) { EXPECT_EQ(fine_detail(waves(0, 0)), 0); }

}  // namespace
}  // namespace photohull
