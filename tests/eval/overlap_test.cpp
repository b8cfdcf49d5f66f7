#include "eval/overlap.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "shapes.h"

namespace photohull::eval {
namespace {

using test::box;
using testing::HasSubstr;

TEST(Overlap, ShiftedBoxes) {
  const TriMesh first = box({0, 0, 0}, {4, 4, 2});
  // Along z lengths are exact; across, to a column.
  const Overlap up = measure_overlap(first, box({0, 0, 0.3}, {4, 4, 2.3}), 64);
  ASSERT_TRUE(up.known) << up.reason;
  EXPECT_NEAR(up.first, 32, 1e-4);
  EXPECT_NEAR(up.second, 32, 1e-4);
  EXPECT_NEAR(up.intersection, 16 * 1.7, 1e-4);
  EXPECT_NEAR(up.iou, 1.7 / 2.3, 1e-6);
  const Overlap aside = measure_overlap(first, box({1, 0.5, 0}, {5, 4.5, 2}), 500);
  ASSERT_TRUE(aside.known);
  EXPECT_NEAR(aside.iou, (3 * 3.5) / (32 - 3 * 3.5), 0.005);
  const Overlap apart = measure_overlap(first, box({5, 5, 5}, {6, 6, 6}), 60);
  EXPECT_EQ(apart.intersection, 0);
  EXPECT_NEAR(apart.together, 33, 0.1);
}

TEST(Overlap, LinesThroughEdgesAndCornersCountOnce) {
  // Columns meet the vertices and the diagonals of these boxes exactly.
  TriMesh fine;
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y) fine = test::together(fine, box({x, y, 0}, {x + 1, y + 1, 1}));
  const TriMesh whole = box({-0.5, -0.5, 0}, {8.5, 8.5, 1});
  for (const int columns : {9, 18, 36}) {
    const Overlap both = measure_overlap(fine, whole, columns);
    ASSERT_TRUE(both.known);
    EXPECT_NEAR(both.first, 64, 1e-6);
    EXPECT_NEAR(both.first, both.intersection, 1e-9);
    EXPECT_NEAR(both.second, 81, 1e-6);
    EXPECT_EQ(both.together, both.second);
  }
}

TEST(Overlap, CavitiesAreEmptyAndOverlapsCountOnce) {
  const TriMesh solid = box({0, 0, 0}, {4, 4, 4});
  const TriMesh hollow = test::together(solid, test::turned_inside_out(box({1, 1, 1}, {3, 3, 3})));
  const Overlap cavity = measure_overlap(hollow, solid, 128);
  EXPECT_NEAR(cavity.first, 64 - 8, 1e-4);
  EXPECT_NEAR(cavity.iou, 56.0 / 64, 1e-6);
  const TriMesh twice = test::together(solid, box({2, 0, 0}, {6, 4, 4}));
  EXPECT_NEAR(measure_overlap(twice, solid, 192).first, 96, 1e-4);
  EXPECT_NEAR(measure_overlap(test::turned_inside_out(solid), solid, 64).iou, 1, 1e-9);
}

TEST(Overlap, SpheresByFormula) {
  const TriMesh a = test::sphere({0, 0, 0}, 1, 6), b = test::sphere({0.5, 0.3, 0}, 1, 6);
  const double d = std::hypot(0.5, 0.3), lens = 3.14159265358979 / 12 * (4 + d) * (2 - d) * (2 - d);
  const double ball = 4.0 / 3 * 3.14159265358979;
  EXPECT_NEAR(measure_overlap(a, b, 256).iou, lens / (2 * ball - lens), 0.002);
}

TEST(Overlap, OpenMeshesHaveNone) {
  TriMesh open = box({0, 0, 0}, {1, 1, 1});
  open.triangles.pop_back();
  const TriMesh closed = box({0, 0, 0}, {1, 1, 1});
  const Overlap result = measure_overlap(open, closed, 32);
  EXPECT_FALSE(result.known);
  EXPECT_THAT(result.reason, HasSubstr("the result is not closed: 3 of its 18 edges"));
  EXPECT_THAT(measure_overlap(closed, open, 32).reason, HasSubstr("the truth is not closed"));
  TriMesh flipped = closed;
  std::swap(flipped.triangles[0][0], flipped.triangles[0][1]);
  EXPECT_FALSE(measure_overlap(flipped, closed, 32).known);
}

TEST(Overlap, FlatClosedMeshesHaveNoVolume) {
  TriMesh flat = test::plate(0, 0, 0, 1, 1);
  flat = test::together(flat, test::turned_inside_out(flat));
  const Overlap result = measure_overlap(flat, flat, 32);
  EXPECT_FALSE(result.known);
  EXPECT_THAT(result.reason, HasSubstr("volume"));
}

}  // namespace
}  // namespace photohull::eval
