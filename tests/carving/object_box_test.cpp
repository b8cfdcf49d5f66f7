#include "carving/object_box.h"

#include <gtest/gtest.h>

#include "support/silhouettes.h"

namespace photohull::carving {
namespace {

constexpr int kWidth = 120, kHeight = 90;
const glm::dvec3 kCentre{0.2, -0.1, 0.3};
constexpr double kRadius = 0.6;

std::vector<PreparedView> views_of_a_ball(int count) {
  std::vector<PreparedView> views;
  for (const Camera& camera : test::cameras_around(kCentre, 5, count, 300, kWidth, kHeight)) {
    PreparedView view;
    view.camera = camera;
    view.mask = test::sphere_outline(camera, kCentre, kRadius).mask;
    views.push_back(std::move(view));
  }
  return views;
}

Box around(double half) { return {kCentre - half, kCentre + half}; }

TEST(ObjectBox, FitsAreNotOversized) {
  const std::vector<PreparedView> views = views_of_a_ball(12);
  EXPECT_FALSE(box_is_oversized(around(kRadius), views));
  EXPECT_FALSE(box_is_oversized(around(1.2 * kRadius), views));
  EXPECT_TRUE(box_is_oversized(around(2.5 * kRadius), views));
  EXPECT_TRUE(box_is_oversized(around(10), views));  // cameras stand inside
}

TEST(ObjectBox, WhatWasNotPhotographedIsNoForeground) {
  std::vector<PreparedView> views = views_of_a_ball(12);
  for (PreparedView& view : views) {
    view.image = {kWidth, kHeight, ColourImage::Encoding::kSrgb8, true, {}};
    view.image.bytes.assign(4 * std::size_t(kWidth) * kHeight, 255);
    for (int y = 0; y < kHeight; ++y)
      for (const int x : {0, kWidth - 1}) {
        const auto i = std::size_t(y) * kWidth + std::size_t(x);
        view.mask.coverage[i] = 255, view.image.bytes[4 * i + 3] = 0;
      }
  }
  EXPECT_TRUE(box_is_oversized(around(2.0 * kRadius), views));
  for (PreparedView& view : views) view.image.has_alpha = false;
  EXPECT_FALSE(box_is_oversized(around(2.0 * kRadius), views));
}

TEST(ObjectBox, ShrinksToWhatTheSilhouettesLeave) {
  const std::vector<PreparedView> views = views_of_a_ball(12);
  for (const double half : {2.0, 6.0, 20.0}) {
    const Box box = object_box(around(half), views);
    for (int i = 0; i < 3; ++i) {
      EXPECT_LT(box.min[i], kCentre[i] - kRadius) << half;
      EXPECT_GT(box.max[i], kCentre[i] + kRadius) << half;
      EXPECT_LT(box.size()[i], 3.2 * kRadius) << half;
    }
  }
}

TEST(ObjectBox, StaysInsideTheBoxThatWasGiven) {
  Box given = around(4);
  given.min.x = kCentre.x;  // half of the ball only
  const Box box = object_box(given, views_of_a_ball(12));
  EXPECT_EQ(box.min.x, given.min.x);
}

TEST(ObjectBox, StaysWhereNothingIsKnown) {
  std::vector<PreparedView> views = views_of_a_ball(6);
  Box elsewhere = around(1);
  elsewhere.min += 30.0, elsewhere.max += 30.0;
  EXPECT_EQ(object_box(elsewhere, views).min, elsewhere.min);
  for (PreparedView& view : views) view.mask = {};
  EXPECT_FALSE(box_is_oversized(around(10), views));
  EXPECT_EQ(object_box(around(10), views).min, around(10).min);
}

}  // namespace
}  // namespace photohull::carving
