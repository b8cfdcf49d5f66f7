// How much one view's silhouette is worth against all others'.
#include <gtest/gtest.h>

#include <cmath>

#include "carving/hull.h"
#include "support/silhouettes.h"

namespace photohull::carving {
namespace {

constexpr int kViews = 6;
constexpr double kRadius = 0.5;  // world
constexpr double kFull = 2;      // pixels
constexpr double kError = 0.1;   // pixels: of the outlines and their interpolation
const Box kBox{glm::dvec3(-0.8), glm::dvec3(0.8)};

/// A ball's outlines, some of which lie so many pixels too far inside.
struct Ball {
  /// `same`: so many views are the first one.
  explicit Ball(const std::vector<double>& too_small, std::size_t same = 1) {
    for (std::size_t i = 1; i < same; ++i) cameras[i] = cameras[0];
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      outlines.push_back(test::sphere_outline(cameras[i], {0, 0, 0}, kRadius));
      const double pixels = i < too_small.size() ? too_small[i] : 0;
      for (float& d : outlines.back().distance.pixels) d += float(pixels);
    }
    for (const test::Outline& o : outlines) silhouettes.push_back({&o.mask, &o.distance});
  }
  /// Pixels by which the hull's surface lies outside the ball's outline, towards the image's right
  /// of the first view: where this view sees its outline.
  double beside() const {
    HullOptions options;
    options.full_evidence = kFull;
    const glm::dvec3 right = glm::transpose(cameras[0].cam_from_world.rotation)[0];
    double low = 0.5 * kRadius, high = 1.5 * kRadius;
    const double pixel = glm::length(cameras[0].center()) / cameras[0].intrinsics.fx;
    for (int i = 0; i < 40; ++i) {
      const double middle = 0.5 * (low + high);
      GridSpec grid{middle * right, pixel, {1, 1, 1}};  // its first voxel is the point
      const double d =
          reference::hull_distance({grid, kBox}, {cameras, silhouettes}, options, {0, 0, 0});
      (d < 0 ? low : high) = middle;
    }
    const double outline =
        kRadius * glm::length(cameras[0].center()) /
        std::sqrt(glm::dot(cameras[0].center(), cameras[0].center()) - kRadius * kRadius);
    return (low - outline) / pixel;
  }

  std::vector<Camera> cameras = test::cameras_around({0, 0, 0}, 5, kViews, 900, 300, 300);
  std::vector<test::Outline> outlines;
  std::vector<Silhouette> silhouettes;
};

// The outline of one view alone passes the place: room is left as far as its evidence is not full.
TEST(Evidence, OneViewThatIsOffDoesNotCarveBeforeItsEvidenceIsFull) {
  EXPECT_NEAR(Ball({}).beside(), kFull, kError);
  EXPECT_NEAR(Ball({1}).beside(), kFull - 1, kError);
  EXPECT_GT(Ball({1}).beside(), 0);
}

TEST(Evidence, OneViewThatIsFarOffCarvesByWhatIsBeyond) {
  EXPECT_NEAR(Ball({10}).beside(), kFull - 10, 2 * kError);
}

TEST(Evidence, ViewsThatAgreeCarveSooner) {
  EXPECT_NEAR(Ball({1, 1, 1, 1}, 4).beside(), kFull / 4 - 1, kError);
  // Three of four that leave the place out, and one that does not.
  EXPECT_NEAR(Ball({1, 1, 1, -5}, 4).beside(), kFull / 3 - 1, kError);
}

}  // namespace
}  // namespace photohull::carving
