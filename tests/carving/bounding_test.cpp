#include "carving/bounding.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/analytic_volumes.h"

namespace photohull::carving {
namespace {

using glm::dvec3;

const Box kBox{dvec3(8), dvec3(40)};  // voxels are units

SparseVolume hull(const Distance& shape) {
  return sample_volume(
      {6, 6, 6}, [&](const dvec3& p) { return std::max(shape(p), box(kBox.min, kBox.max)(p)); });
}

/// So many views, of which `masked` have a silhouette.
std::vector<Silhouette> silhouettes(int views, int masked) {
  static const SilhouetteDistance some{};
  std::vector<Silhouette> out(std::size_t(views), Silhouette{});
  for (int i = 0; i < masked; ++i) out[std::size_t(i)].distance = &some;
  return out;
}

TEST(Bounding, ObjectsWithinTheBoxAreBounded) {
  const SparseVolume ball = hull(sphere({24, 24, 24}, 10));
  EXPECT_EQ(share_at_box(ball, kBox), 0);
  EXPECT_TRUE(silhouettes_bound(ball, kBox, silhouettes(10, 10)));
  // A bust whose base the box cuts off.
  const SparseVolume bust = hull(sphere({24, 24, 12}, 12));
  EXPECT_GT(share_at_box(bust, kBox), 0.1);
  EXPECT_TRUE(silhouettes_bound(bust, kBox, silhouettes(10, 10)));
}

TEST(Bounding, HalfOfTheViewsMustHaveMasks) {
  const SparseVolume ball = hull(sphere({24, 24, 24}, 10));
  EXPECT_TRUE(silhouettes_bound(ball, kBox, silhouettes(10, 5)));
  EXPECT_FALSE(silhouettes_bound(ball, kBox, silhouettes(10, 4)));
}

TEST(Bounding, MasksThatLeaveOutTheSkyAloneBoundNothing) {
  const SparseVolume ground = hull([](const dvec3& p) { return p.z - 24; });
  EXPECT_NEAR(share_at_box(ground, kBox), 1 - 1 / 4.0, 0.03);  // all but its top
  EXPECT_FALSE(silhouettes_bound(ground, kBox, silhouettes(10, 10)));
}

TEST(Bounding, NothingIsNotBounded) {
  const SparseVolume nothing = hull([](const dvec3&) { return 1.0; });
  EXPECT_EQ(share_at_box(nothing, kBox), 1);
}

}  // namespace
}  // namespace photohull::carving
