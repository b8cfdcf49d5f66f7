#include "refine/trust.h"

#include <gtest/gtest.h>

#include "support/analytic_volumes.h"
#include "support/cameras.h"

namespace photohull::refine {
namespace {

using glm::dvec3;
using glm::vec3;

TEST(TrustThickness, GrowsWithTheDepthOfBody) {
  // A wall of 2.4 voxels, and one of 20.
  const SparseVolume volume = sample_volume({4, 4, 4}, [](const dvec3& p) {
    return std::min(std::abs(p.x - 5.5) - 1.2, std::abs(p.x - 20) - 10.0);
  });
  const std::vector<vec3> positions{{6.7, 16, 16}, {30, 16, 16}, {30, 16, 16}};
  const std::vector<vec3> normals{{1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
  const std::vector<float> trust = trust_thickness(volume, positions, normals, 4);
  EXPECT_NEAR(trust[0], 9.0 / 16, 1e-6);
  EXPECT_EQ(trust[1], 1);
  EXPECT_NEAR(trust[2], 1.0 / 16, 1e-6) << "nothing behind";
  EXPECT_TRUE(trust_thickness(volume, {}, {}, 4).empty());
}

class TrustOutlines : public testing::Test {
 protected:
  TrustOutlines() {
    // Two cameras 100 voxels above the middle; a pixel is a voxel there. Outline: x = 20 pixels
    // right of the middle in the first, no contour in the second.
    for (int i = 0; i < 2; ++i) {
      cameras_.push_back(test::look_at(dvec3(16, 16, 116), dvec3(16), 100, 64, 64, dvec3(0, 1, 0)));
      SilhouetteDistance d{64, 64, std::vector<float>(64 * 64)};
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
          d.pixels[std::size_t(y) * 64 + std::size_t(x)] =
              i == 0 ? float(x - 40) : -SilhouetteDistance::kNoContour;
      distances_.push_back(d);
    }
    options_.least_spacing = 0.4, options_.pixel_spacing = 1.5;
  }

  /// Of a surfel that lies `inside` pixels within the first view's outline.
  float trust(double inside, const std::vector<int>& views, bool masks = true) {
    const glm::dvec2 centre = glm::dvec2(31.5);
    // Which way x runs in the image is the camera's business.
    const dvec3 right = glm::transpose(cameras_[0].cam_from_world.rotation)[0];
    const vec3 position(dvec3(16) + right * (40 - inside - centre.x));
    ViewChoice choice;
    choice.views = ViewList<ViewChoice::kMostViews>(views);
    std::vector<carving::Silhouette> silhouettes(2);
    for (std::size_t i = 0; masks && i < 2; ++i) silhouettes[i].distance = &distances_[i];
    std::vector<float> out{0.5f};
    trust_outlines({dvec3(0), 1, {4, 4, 4}}, std::vector{position}, std::vector{choice},
                   {cameras_, silhouettes}, options_, out);
    return 2 * out[0];
  }

  std::vector<Camera> cameras_;
  std::vector<SilhouetteDistance> distances_;
  FitOptions options_;
};

TEST_F(TrustOutlines, FallsFromHalfAPatchToTheOutline) {
  EXPECT_FLOAT_EQ(trust(6, {0}), 1);
  EXPECT_FLOAT_EQ(trust(3, {0}), 1) << "two taps of 1.5 pixels";
  EXPECT_NEAR(trust(1, {0}), 1.0 / 9, 1e-5);
  EXPECT_EQ(trust(-1, {0}), 0);
}

TEST_F(TrustOutlines, TheLeastOfTheChosenViewsCounts) {
  EXPECT_FLOAT_EQ(trust(1, {1}), 1) << "no contour";
  EXPECT_NEAR(trust(1, {1, 0}), 1.0 / 9, 1e-5);
  EXPECT_FLOAT_EQ(trust(1, {}), 1);
  EXPECT_FLOAT_EQ(trust(1, {0}, false), 1) << "no silhouette";
}

}  // namespace
}  // namespace photohull::refine
