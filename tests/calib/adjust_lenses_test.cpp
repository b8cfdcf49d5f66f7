#include "calib/adjust_lenses.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/error.h"

namespace photohull {
namespace {

constexpr double kFocal = 1200, kNoise = 0.1, kDistance = 6;
constexpr int kWidth = 640, kHeight = 480;
const glm::dvec2 kMiddle(0.5 * (kWidth - 1), 0.5 * (kHeight - 1));

struct Ring {
  int count;
  double elevation;  ///< degrees
};

Camera look_from(double azimuth, double elevation) {
  const glm::dvec3 up(std::cos(elevation) * std::cos(azimuth),
                      std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 0, 1), up));
  Camera camera;
  camera.intrinsics = {kWidth, kHeight, kFocal, kFocal, 0, kMiddle.x, kMiddle.y};
  camera.cam_from_world.rotation = glm::transpose(glm::dmat3(right, -glm::cross(up, right), -up));
  camera.cam_from_world.translation = camera.cam_from_world.rotation * (-kDistance * up);
  return camera;
}

/// Cameras in rings around points on a sphere, and what a mapper makes of their tracks: principal
/// points in `assumed`, which turns make up for, and a focal length that is 2 % too long.
class Photographs {
 public:
  explicit Photographs(const std::vector<Ring>& rings,
                       const std::vector<glm::dvec2>& offsets = {{14, -9}},
                       const glm::dvec2& assumed = kMiddle) {
    for (const Ring& ring : rings)
      for (int i = 0; i < ring.count; ++i) {
        Camera camera = look_from(2 * std::numbers::pi * i / ring.count,
                                  ring.elevation * std::numbers::pi / 180);
        lenses.push_back(truth.size() % offsets.size());
        camera.intrinsics.cx += offsets[lenses.back()].x;
        camera.intrinsics.cy += offsets[lenses.back()].y;
        truth.push_back(camera);
        scene.views.push_back(
            {std::to_string(truth.size()), {}, {}, as_mapped(camera, assumed), {}});
      }
    for (int i = 0; i < 1000; ++i) add_track();
  }

  /// Observations of every tenth track lie elsewhere by a few pixels.
  void spoil() {
    for (std::size_t t = 0; t < scene.tracks.size(); t += 10)
      scene.tracks[t].observations[0].pixel += glm::dvec2(4, -3);
  }

  glm::dvec2 principal_error(std::size_t view) const {
    const Intrinsics &k = scene.views[view].camera.intrinsics, &t = truth[view].intrinsics;
    return {k.cx - t.cx, k.cy - t.cy};
  }
  double focal_error(std::size_t view) const {
    return scene.views[view].camera.intrinsics.fx / kFocal - 1;
  }
  std::vector<AdjustedLens> adjust() { return adjust_lenses(scene, lenses, progress); }

  std::vector<Camera> truth;
  std::vector<std::size_t> lenses;
  Scene scene;
  Progress progress;

 private:
  static Camera as_mapped(Camera camera, const glm::dvec2& assumed) {
    const glm::dvec2 offset(camera.intrinsics.cx - assumed.x, camera.intrinsics.cy - assumed.y);
    const glm::dvec3 seen = glm::normalize(glm::dvec3(offset / kFocal, 1.0));
    const glm::dvec3 x = glm::normalize(glm::dvec3(seen.z, 0, -seen.x));
    const glm::dmat3 turn(x, glm::cross(seen, x), seen);
    camera.cam_from_world.rotation = turn * camera.cam_from_world.rotation;
    camera.cam_from_world.translation = 1.02 * (turn * camera.cam_from_world.translation);
    camera.intrinsics.fx = camera.intrinsics.fy = 1.02 * kFocal;
    camera.intrinsics.cx = assumed.x, camera.intrinsics.cy = assumed.y;
    return camera;
  }

  double uniform() { return double(random_()) / double(std::mt19937::max()); }
  double normal() {
    return std::sqrt(-2 * std::log(1 - 0.999999 * uniform())) *
           std::cos(2 * std::numbers::pi * uniform());
  }
  void add_track() {
    const glm::dvec3 out = glm::normalize(glm::dvec3(normal(), normal(), normal()));
    const glm::dvec3 point = (0.7 + 0.3 * uniform()) * out;
    SceneTrack track;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      if (glm::dot(out, glm::normalize(truth[i].center() - point)) < 0.4) continue;
      track.observations.push_back(
          {int(i), *truth[i].project(point) + kNoise * glm::dvec2(normal(), normal())});
    }
    if (track.observations.size() > 2) scene.tracks.push_back(track);
  }

  std::mt19937 random_{5};
};

TEST(AdjustLenses, FindsAPrincipalPointThatTwoRingsTell) {
  Photographs photos({{12, 20}, {12, 55}});
  const std::vector<AdjustedLens> lenses = photos.adjust();
  ASSERT_EQ(lenses.size(), 1u);
  EXPECT_EQ(lenses[0].views, 24);
  EXPECT_LT(glm::length(photos.principal_error(0)), 2);
  EXPECT_NEAR(photos.focal_error(0), 0, 0.01);
  EXPECT_LT(lenses[0].principal_sigma.x, 1.5);
  EXPECT_LT(lenses[0].principal_sigma.y, 5);
  // Points are where the cameras see them.
  ASSERT_EQ(photos.scene.points.size(), photos.scene.tracks.size());
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t t = 0; t < photos.scene.tracks.size(); ++t)
    for (const auto& o : photos.scene.tracks[t].observations) {
      const SourceView& view = photos.scene.views[std::size_t(o.view)];
      const glm::dvec2 off = *view.camera.project(photos.scene.points[t]) - o.pixel;
      sum += glm::dot(off, off), ++count;
    }
  EXPECT_LT(std::sqrt(sum / double(2 * count)), 1.1 * kNoise);
}

TEST(AdjustLenses, LeavesInTheMiddleWhatOneRingDoesNotTell) {
  Photographs photos({{24, 35}});
  const std::vector<AdjustedLens> lenses = photos.adjust();
  ASSERT_EQ(lenses.size(), 1u);
  EXPECT_LT(std::abs(photos.principal_error(0).x), 2);
  EXPECT_NEAR(photos.scene.views[0].camera.intrinsics.cy, kMiddle.y, 3);
  EXPECT_NEAR(photos.focal_error(0), 0, 0.01);
  EXPECT_LT(lenses[0].principal_sigma.x, 1.5);
  EXPECT_GT(lenses[0].principal_sigma.y, 6);
  EXPECT_LT(lenses[0].principal_sigma.y, 0.0151 * kWidth);  // the prior's
}

TEST(AdjustLenses, BringsBackToTheMiddleWhatOneRingDoesNotTell) {
  Photographs photos({{24, 35}}, {{14, -9}}, kMiddle - glm::dvec2(0, 40));
  ASSERT_EQ(photos.adjust().size(), 1u);
  EXPECT_LT(std::abs(photos.principal_error(0).x), 2);
  EXPECT_NEAR(photos.scene.views[0].camera.intrinsics.cy, kMiddle.y, 3);
  EXPECT_NEAR(photos.focal_error(0), 0, 0.01);
}

TEST(AdjustLenses, FindsEachLensOfSeveral) {
  Photographs photos({{16, 20}, {15, 55}}, {{14, -9}, {-8, 4}});
  const std::vector<AdjustedLens> lenses = photos.adjust();
  ASSERT_EQ(lenses.size(), 2u);
  EXPECT_EQ(lenses[0].views, 16);
  EXPECT_EQ(lenses[1].views, 15);
  for (const std::size_t view : {0u, 1u})
    EXPECT_LT(glm::length(photos.principal_error(view)), 3) << view;
}

TEST(AdjustLenses, WrongObservationsDoNotMatter) {
  Photographs photos({{12, 20}, {12, 55}});
  photos.spoil();
  ASSERT_EQ(photos.adjust().size(), 1u);
  EXPECT_LT(glm::length(photos.principal_error(0)), 2);
  EXPECT_NEAR(photos.focal_error(0), 0, 0.01);
}

TEST(AdjustLenses, GivesTheSameTwice) {
  Photographs photos({{8, 20}, {8, 55}}), again({{8, 20}, {8, 55}});
  photos.adjust(), again.adjust();
  EXPECT_EQ(photos.scene.views[3].camera.intrinsics.cy, again.scene.views[3].camera.intrinsics.cy);
  EXPECT_EQ(photos.scene.points, again.scene.points);
}

TEST(AdjustLenses, TakesCamerasAsTheyAreWithoutTracks) {
  Photographs photos({{8, 35}});
  photos.scene.tracks.clear();
  photos.scene.points = {{1, 2, 3}};
  EXPECT_TRUE(photos.adjust().empty());
  EXPECT_EQ(photos.scene.views[0].camera.intrinsics.cx, kMiddle.x);
  EXPECT_EQ(photos.scene.points.size(), 1u);
  Scene nothing;
  EXPECT_TRUE(adjust_lenses(nothing, {}, photos.progress).empty());
}

TEST(AdjustLenses, EndsWhereItIsCancelled) {
  Photographs photos({{8, 35}});
  const CancellationToken token;
  token.cancel();
  Progress progress(token);
  EXPECT_THROW(adjust_lenses(photos.scene, photos.lenses, progress), Cancelled);
}

}  // namespace
}  // namespace photohull
