#include "assess/common_error.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/ray_cast.h"

namespace photohull::assess {
namespace {

/// Clockwise on the screen, where y points down, by gift wrapping.
std::vector<glm::dvec2> convex_hull(const std::vector<glm::dvec2>& points) {
  glm::dvec2 at = points.front();
  for (const glm::dvec2& p : points)
    if (p.x < at.x) at = p;
  std::vector<glm::dvec2> hull;
  do {
    hull.push_back(at);
    glm::dvec2 next = points.front() == at ? points.back() : points.front();
    for (const glm::dvec2& p : points) {
      const glm::dvec2 a = next - at, b = p - at;
      if (a.x * b.y - a.y * b.x < 0) next = p;
    }
    at = next;
  } while (at != hull.front() && hull.size() <= points.size());
  return hull;
}

/// Twenty cameras around a slanted wedge, at three heights.
std::vector<Camera> cameras() {
  std::vector<Camera> out;
  for (int i = 0; i < 20; ++i) {
    const double a = 0.7 * i;
    out.push_back(test::look_at({4 * std::cos(a), 4 * std::sin(a), 1.5 * (i % 3) - 1}, {0, 0, 0},
                                220, 200, 200));
  }
  return out;
}

std::vector<Outline> outlines(const std::vector<Camera>& seen_by, const glm::dvec2& shift = {}) {
  const glm::dvec3 corners[] = {{-1, -0.6, -0.4},  {1, -0.5, -0.5},  {0.9, 0.6, -0.4},
                                {-0.9, 0.5, -0.5}, {-0.7, 0.1, 0.7}, {0.2, -0.3, 0.9},
                                {0.6, 0.5, 0.4}};
  std::vector<Outline> out;
  for (const Camera& camera : seen_by) {
    std::vector<glm::dvec2> points;
    for (const glm::dvec3& corner : corners) points.push_back(*camera.project(corner) + shift);
    out.push_back({convex_hull(points), 200, 200});
  }
  return out;
}

TEST(CommonError, RightCamerasAskForNothing) {
  const CommonError e = find_common_error(cameras(), outlines(cameras()));
  EXPECT_GT(e.tangents, 200);
  EXPECT_NEAR(glm::length(e.shift), 0, 1e-6);
  EXPECT_NEAR(e.focal_factor, 1, 1e-6);
  EXPECT_FALSE(e.shift_counts());
  EXPECT_FALSE(e.focal_counts());
}

TEST(CommonError, FocalLengthsThatAreOffAreMeasured) {
  std::vector<Camera> wrong = cameras();
  for (Camera& camera : wrong) camera.intrinsics.fx *= 1.1, camera.intrinsics.fy *= 1.1;
  const CommonError e = find_common_error(wrong, outlines(cameras()));
  EXPECT_NEAR(e.focal_factor, 1 / 1.1, 1e-3);
  EXPECT_NEAR(glm::length(e.shift), 0, 0.05);
  EXPECT_TRUE(e.focal_counts());
  EXPECT_FALSE(e.shift_counts());
  EXPECT_LT(e.after, 0.1 * e.before);
}

TEST(CommonError, MasksThatAreShiftedAreMeasured) {
  const CommonError e = find_common_error(cameras(), outlines(cameras(), {8, -3}));
  EXPECT_NEAR(e.shift.x, 8, 0.05);
  EXPECT_NEAR(e.shift.y, -3, 0.05);
  EXPECT_NEAR(e.focal_factor, 1, 1e-3);
  EXPECT_TRUE(e.shift_counts());
  EXPECT_FALSE(e.focal_counts());
}

// What is wrong with single views is no error of all.
TEST(CommonError, OneWrongViewIsNoCommonError) {
  std::vector<Camera> wrong = cameras();
  wrong[4].intrinsics.cx += 20;
  const CommonError e = find_common_error(wrong, outlines(cameras()));
  EXPECT_FALSE(e.shift_counts());
  EXPECT_FALSE(e.focal_counts());
}

TEST(CommonError, FewTangentsTellNothing) {
  std::vector<Camera> three = cameras();
  three.resize(3);
  EXPECT_EQ(find_common_error(three, outlines(three)).tangents, 0);
  EXPECT_EQ(find_common_error(cameras(), std::vector<Outline>(20)).tangents, 0);
}

}  // namespace
}  // namespace photohull::assess
