// Photographs of the temple, whose cameras are put off.
#include "cameras/look_at_cameras.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cameras/near_views.h"
#include "cameras/refine_cameras.h"
#include "core/error.h"
#include "io/image_file.h"
#include "io/load_scene.h"
#include "support/cameras.h"
#include "support/places.h"
#include "views/prepare_views.h"

namespace photohull {
namespace {

std::vector<PreparedView> temple() {
  Progress progress;
  const ViewLoader loader{[](const auto& file) { return io::read_image(file); },
                          [](const auto& file) { return io::read_mask(file); }};
  Scene scene = io::load_scene(test::in_checkout("datasets/templeSparseRing"));
  return prepare_views(scene, loader, {}, progress).views;
}

void put_off(std::vector<PreparedView>& views, double pixels) {
  for (std::size_t i = 0; i < views.size(); ++i)
    views[i].camera = test::put_off(views[i].camera, pixels, int(i));
}

TEST(FeatureAgreement, TellsHowFarCamerasAreOff) {
  std::vector<PreparedView> views = temple();
  Progress progress;
  const FeatureAgreement right = look_at_features(views, progress);
  EXPECT_LT(right.pixels, right.suspicious);
  EXPECT_GE(right.pairs, 2);
  EXPECT_GE(right.matches, 8 * right.pairs);
  put_off(views, 3);
  EXPECT_NEAR(look_at_features(views, progress).pixels, 3, 1.5);
  put_off(views, 27);
  EXPECT_NEAR(look_at_features(views, progress).pixels, 30, 15);
}

/// The photograph with each pixel repeated four times in both directions, and its camera.
PreparedView enlarged(const PreparedView& view) {
  constexpr int kTimes = 4;
  PreparedView large;
  large.image = {kTimes * view.image.width, kTimes * view.image.height};
  for (int y = 0; y < large.image.height; ++y)
    for (int x = 0; x < large.image.width; ++x) {
      const auto from = (std::size_t(y / kTimes) * view.image.width + x / kTimes) * 4;
      large.image.bytes.insert(large.image.bytes.end(), &view.image.bytes[from],
                               &view.image.bytes[from] + 4);
    }
  large.camera = view.camera;
  Intrinsics& k = large.camera.intrinsics;
  k.width *= kTimes, k.height *= kTimes;
  k.fx *= kTimes, k.fy *= kTimes, k.skew *= kTimes;
  k.cx = (k.cx + 0.5) * kTimes - 0.5, k.cy = (k.cy + 0.5) * kTimes - 0.5;
  return large;
}

TEST(FeatureAgreement, IsInPixelsOfLargePhotographs) {
  std::vector<PreparedView> views = temple();
  for (PreparedView& view : views) {
    view.mask = {};
    view = enlarged(view);
  }
  Progress progress;
  const FeatureAgreement right = look_at_features(views, progress);
  EXPECT_NEAR(right.suspicious, 0.25 * 2, 1e-9);
  EXPECT_LT(right.pixels, 4 * 0.4);  // repeated pixels are found less exactly
  put_off(views, 12);
  EXPECT_NEAR(look_at_features(views, progress).pixels, 12, 6);
}

/// The temple on a turntable, before a wall that moves in no photograph, and without masks.
std::vector<PreparedView> temple_before_wall() {
  std::vector<PreparedView> views = temple();
  for (PreparedView& view : views) {
    view.mask = {};
    std::uint32_t random = 7;
    std::vector<std::uint8_t> wall(std::size_t(view.image.width / 8 + 1) *
                                   (view.image.height / 8 + 1));
    for (std::uint8_t& level : wall)
      level = std::uint8_t((random = random * 1664525 + 1013904223) >> 24);
    for (int y = 0; y < view.image.height; ++y)
      for (int x = 0; x < view.image.width; ++x) {
        std::uint8_t* pixel = &view.image.bytes[(std::size_t(y) * view.image.width + x) * 4];
        if (pixel[0] < 40)
          std::fill(pixel, pixel + 3,
                    wall[std::size_t(y / 8) * (view.image.width / 8 + 1) + x / 8]);
      }
  }
  return views;
}

TEST(FeatureAgreement, IsNotMisledByABackgroundThatStandsStill) {
  const std::vector<PreparedView> views = temple_before_wall();
  Progress progress;
  const FeatureAgreement found = look_at_features(views, progress);
  EXPECT_FALSE(found.pixels > found.suspicious) << found.pixels;
}

TEST(FeatureAgreement, IsNotKnownWherePhotographsShowNothing) {
  std::vector<PreparedView> views = temple();
  for (PreparedView& view : views)
    std::fill(view.image.bytes.begin(), view.image.bytes.end(), std::uint8_t(90));
  Progress progress;
  const FeatureAgreement none = look_at_features(views, progress);
  EXPECT_TRUE(std::isnan(none.pixels));
  EXPECT_EQ(none.pairs, 0);
  EXPECT_TRUE(std::isnan(look_at_features(std::span(views).first(1), progress).pixels));
}

TEST(FeatureAgreement, StopsWhenCancelled) {
  const std::vector<PreparedView> views = temple();
  Progress progress{CancellationToken()};
  progress.token().cancel();
  EXPECT_THROW(look_at_features(views, progress), Cancelled);
}

// Many matches are wrong where columns repeat, and any camera leaves them off.
TEST(RefineTemple, CamerasThatAreFarOffComeToAgree) {
  for (const double pixels : {6, 12}) {
    std::vector<PreparedView> views = temple();
    put_off(views, pixels);
    Progress progress;
    const CameraRefinement found = refine_cameras(views, {}, progress);
    EXPECT_TRUE(found.changed) << pixels;
    EXPECT_GT(found.all.before, 0.4 * pixels);
    EXPECT_LT(found.all.after, 0.3) << pixels;
    EXPECT_LT(found.tangents_after, 0.3 * found.tangents_before) << pixels;
  }
}

Camera looking(const glm::dvec3& center, const glm::dvec3& forward) {
  return test::look_at(center, center + forward, 500, 640, 480, {0, 1, 0.1});
}

TEST(RefineTemple, AWallThatStandsStillDrawsNoCamera) {
  std::vector<PreparedView> views = temple_before_wall(), without_wall = temple();
  put_off(views, 3);
  put_off(without_wall, 3);
  Progress progress;
  const double before = look_at_features(without_wall, progress).pixels;
  const CameraRefinement found = refine_cameras(views, {}, progress);
  for (std::size_t i = 0; i < views.size(); ++i) without_wall[i].camera = found.cameras[i];
  EXPECT_LT(look_at_features(without_wall, progress).pixels, 1.5 * before);
}

TEST(NearViews, ADronesAreThoseBesideIt) {
  // A row of photographs from above, each tilted a little another way.
  std::vector<Camera> cameras;
  for (int i = 0; i < 20; ++i)
    cameras.push_back(
        looking({i, 0, 10}, {0.05 * std::sin(5.0 * i), 0.05 * std::cos(5.0 * i), -1}));
  EXPECT_THAT(nearest_views(cameras, 10, 2, 45), testing::UnorderedElementsAre(9, 11));
  EXPECT_THAT(nearest_views(cameras, 0, 2, 45), testing::ElementsAre(1, 2));
}

TEST(NearViews, AroundAnObjectAreThoseThatLookAlike) {
  std::vector<Camera> cameras;
  for (int i = 0; i < 12; ++i) {
    const glm::dvec3 center(5 * std::cos(i * std::numbers::pi / 6),
                            5 * std::sin(i * std::numbers::pi / 6), 1);
    cameras.push_back(looking(center, -center));
  }
  EXPECT_THAT(nearest_views(cameras, 0, 2, 45), testing::UnorderedElementsAre(1, 11));
  EXPECT_TRUE(nearest_views(cameras, 0, 4, 20).empty());  // the next are 30 degrees away
  // One that stands beside the first but looks the other way sees something else.
  cameras.push_back(looking({5, 0.1, 1}, {1, 0, 0}));
  EXPECT_THAT(nearest_views(cameras, 0, 2, 45), testing::UnorderedElementsAre(1, 11));
}

}  // namespace
}  // namespace photohull
