#include "pipeline/find_box.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "core/error.h"

namespace photohull::pipeline {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;
using testing::ThrowsMessage;

constexpr int kWidth = 400, kHeight = 300;

/// A view without pixels from `eye` towards `target`, z up; 53 degrees wide.
PreparedView looking(const glm::dvec3& eye, const glm::dvec3& target) {
  const glm::dvec3 forward = glm::normalize(target - eye);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
  const glm::dvec3 down = glm::cross(forward, right);
  Camera camera;
  camera.intrinsics = {kWidth, kHeight, 400, 400, 0, 199.5, 149.5};
  camera.cam_from_world.rotation = glm::transpose(glm::dmat3(right, down, forward));
  camera.cam_from_world.translation = -(camera.cam_from_world.rotation * eye);
  return {"", camera, {}, {}};
}

std::vector<PreparedView> ring(int count, double radius, double height) {
  std::vector<PreparedView> views;
  for (int i = 0; i < count; ++i) {
    const double a = 2 * std::numbers::pi * i / count;
    views.push_back(looking({radius * std::cos(a), radius * std::sin(a), height}, {0, 0, 0.3}));
  }
  return views;
}

/// Points with the views that have them on their images.
class Points {
 public:
  explicit Points(const std::vector<PreparedView>& views) : views_(views) {}

  /// On all sides of a box, `count` of them.
  void scatter(const Box& box, int count) {
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < count; ++i) {
      glm::dvec3 p(share(random_), share(random_), share(random_));
      p[i % 3] = double(i / 3 % 2);
      add(box.min + p * box.size());
    }
  }
  void add(const glm::dvec3& p) {
    ScenePoint point{p, {}};
    for (int v = 0; v < int(views_.size()); ++v) {
      const auto pixel = views_[std::size_t(v)].camera.project(p);
      if (pixel && views_[std::size_t(v)].camera.on_image(*pixel)) point.views.push_back(v);
    }
    if (point.views.size() >= 2) all.push_back(std::move(point));
  }
  std::vector<ScenePoint> all;

 private:
  const std::vector<PreparedView>& views_;
  std::mt19937 random_{7};
};

FoundBox find(const std::vector<PreparedView>& views, const Points& points) {
  Progress silent;
  return find_box({views, false, points.all}, silent);
}

double volume(const Box& box) { return box.size().x * box.size().y * box.size().z; }

/// The found box holds 99 % of the volume of `expected` and at most `most` times as much.
void expect_around(const Box& found, const Box& expected, double most = 2) {
  const Box common{glm::max(found.min, expected.min), glm::min(found.max, expected.max)};
  const glm::dvec3 s = glm::max(common.size(), glm::dvec3(0));
  EXPECT_GT(s.x * s.y * s.z, 0.99 * volume(expected));
  EXPECT_LT(volume(found), most * volume(expected));
}

TEST(FindBox, TakesTheObjectAndItsTableRatherThanTheRoom) {
  const std::vector<PreparedView> views = ring(20, 3, 1.5);
  const Box table{{-0.8, -0.6, -0.05}, {0.8, 0.6, 0}}, figure{{-0.2, -0.2, 0}, {0.2, 0.2, 0.7}};
  Points points(views);
  points.scatter(table, 400);
  points.scatter(figure, 300);
  points.scatter({{-6, -6, -1}, {6, 6, 3}}, 4000);  // walls, floor and ceiling
  const FoundBox found = find(views, points);
  expect_around(found.box, {table.min, {0.8, 0.6, 0.7}});
  EXPECT_THAT(found.source, StartsWith("found: "));
  EXPECT_THAT(found.source, HasSubstr("points of the scene file"));
  EXPECT_THAT(found.source, HasSubstr("20 cameras look at one place"));
  EXPECT_THAT(found.warnings, IsEmpty());
}

TEST(FindBox, LeavesFalseMatchesOut) {
  const std::vector<PreparedView> views = ring(12, 3, 1);
  const Box object{{-0.5, -0.4, 0}, {0.5, 0.4, 0.6}};
  Points points(views);
  points.scatter(object, 500);
  points.scatter({{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}}, 25);
  for (ScenePoint& p : points.all)
    if (!object.contains(p.position)) p.views.resize(2);
  expect_around(find(views, points).box, object);
}

TEST(FindBox, TakesTheFacadeThatSeveralParallelViewsSee) {
  std::vector<PreparedView> views;
  for (int i = 0; i < 9; ++i) views.push_back(looking({i - 4.0, -8, 1}, {i - 4.0, 0, 1}));
  Points points(views);
  points.scatter({{-6, -0.1, -1.5}, {6, 0.3, 3.5}}, 1500);
  points.scatter({{-30, 25, -3}, {30, 30, 12}}, 300);  // what stands behind
  const FoundBox found = find(views, points);
  EXPECT_LT(found.box.min.x, -5);
  EXPECT_GT(found.box.max.x, 5);
  EXPECT_LT(found.box.max.y, 3);
  EXPECT_GT(found.box.min.y, -4);
  EXPECT_THAT(found.source, HasSubstr("look at the same"));
}

const Box kCourtyard{{-6, -6, -1}, {6, 6, 4}};

/// A courtyard from within, seen all around.
std::vector<PreparedView> courtyard_views() {
  std::vector<PreparedView> views;
  for (int i = 0; i < 12; ++i) {
    const double a = 2 * std::numbers::pi * i / 12;
    for (const double from : {0.0, 0.6})
      views.push_back(looking({from, -from, 1}, {5 * std::cos(a), 5 * std::sin(a), 1}));
  }
  return views;
}

TEST(FindBox, HoldsNoCameraUnlessNearlyAllStandWithin) {
  std::vector<PreparedView> views = courtyard_views();
  for (int i = 0; i < 5; ++i) views.push_back(looking({16, 3.0 * i - 6, 1}, {0, 3.0 * i - 6, 1}));
  Points points(views);
  points.scatter(kCourtyard, 3000);
  const FoundBox found = find(views, points);
  for (const PreparedView& view : views) EXPECT_FALSE(found.box.contains(view.camera.center()));
  EXPECT_GT(found.points.size(), 100u);
  ASSERT_EQ(found.warnings.size(), 1u);
  EXPECT_THAT(found.warnings[0], HasSubstr("cameras stand among what they show"));
}

TEST(FindBox, RoomHoldsItsCameras) {
  const std::vector<PreparedView> views = courtyard_views();
  Points points(views);
  points.scatter(kCourtyard, 3000);
  const FoundBox found = find(views, points);
  for (const PreparedView& view : views) EXPECT_TRUE(found.box.contains(view.camera.center()));
  EXPECT_GT(found.box.min.x, -7.5);
  EXPECT_LT(found.box.max.x, 7.5);
  EXPECT_THAT(found.source, HasSubstr("as in a room"));
  EXPECT_THAT(found.warnings, IsEmpty());
}

/// A silhouette of the ball of radius 0.5 around (0, 0, 0.3).
Mask ball_mask(const Camera& camera, int widest = 255) {
  Mask mask{kWidth, kHeight, {}};
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const glm::dvec3 to = glm::dvec3(0, 0, 0.3) - camera.center();
      const glm::dvec3 ray = camera.ray({x, y});
      mask.coverage.push_back(glm::length(to - glm::dot(to, ray) * ray) < 0.5 ? std::uint8_t(widest)
                                                                              : 0);
    }
  return mask;
}

TEST(FindBox, TakesTheSilhouettesSpaceWhereMasksAreGiven) {
  std::vector<PreparedView> views = ring(10, 3, 1.5);
  for (PreparedView& view : views) view.mask = ball_mask(view.camera);
  Points room(views);
  room.scatter({{-2, -2, -1}, {2, 2, 2}}, 500);
  Progress silent;
  const FoundBox found = find_box({views, true, room.all}, silent);
  expect_around(found.box, {{-0.5, -0.5, -0.2}, {0.5, 0.5, 0.8}}, 2.2);
  EXPECT_THAT(found.source, HasSubstr("silhouettes of 10 views"));
}

TEST(FindBox, DoesNotTakeMasksForTheObjectsOutlineThatFillTheirPhotographs) {
  std::vector<PreparedView> views = ring(10, 3, 1.5);
  for (PreparedView& view : views)
    view.mask = {kWidth, kHeight, std::vector<std::uint8_t>(std::size_t(kWidth) * kHeight, 255)};
  const Box object{{-0.5, -0.4, 0}, {0.5, 0.4, 0.6}};
  Points points(views);
  points.scatter(object, 500);
  Progress silent;
  const FoundBox found = find_box({views, true, points.all}, silent);
  expect_around(found.box, object);
  EXPECT_THAT(found.source, HasSubstr("points of the scene file"));
}

/// The same grey everywhere.
void make_plain(std::vector<PreparedView>& views) {
  for (PreparedView& view : views)
    view.image = {kWidth, kHeight, ColourImage::Encoding::kSrgb8, false,
                  std::vector<std::uint8_t>(std::size_t(4) * kWidth * kHeight, 120)};
}

TEST(FindBox, SaysWhenPlainPicturesTellNothing) {
  std::vector<PreparedView> views = ring(4, 3, 1);
  make_plain(views);
  Progress silent;
  EXPECT_THAT([&] { find_box({views}, silent); },
              ThrowsMessage<Error>(AllOf(HasSubstr("0 features match"),
                                         HasSubstr("there are no masks"), HasSubstr("give box"))));
}

TEST(FindBox, SaysWhenCamerasLookAwayFromEachOther) {
  std::vector<PreparedView> views;
  for (int i = 0; i < 6; ++i) {
    const double a = 2 * std::numbers::pi * i / 6;
    const glm::dvec3 eye(std::cos(a), std::sin(a), 0);
    views.push_back(looking(eye, 2.0 * eye));
  }
  make_plain(views);
  Progress silent;
  EXPECT_THAT([&] { find_box({views}, silent); },
              ThrowsMessage<Error>(AllOf(HasSubstr("look away from each other"),
                                         HasSubstr("behind 6 of 6 cameras"),
                                         HasSubstr("world-to-camera"))));
}

TEST(FindBox, WantsTwoCameras) {
  std::vector<PreparedView> views = ring(1, 3, 1);
  Progress silent;
  EXPECT_THAT([&] { find_box({views}, silent); },
              ThrowsMessage<Error>(HasSubstr("two cameras or more, but there is 1")));
}

TEST(MeetingOfAxes, TellsWhetherCamerasLookAtOnePlace) {
  std::vector<Camera> around, parallel;
  for (const PreparedView& view : ring(8, 3, 1.5)) around.push_back(view.camera);
  for (int i = 0; i < 5; ++i) parallel.push_back(looking({i, -8, 1}, {i, 0, 1}).camera);
  const AxesMeeting meeting = meeting_of_axes(around);
  EXPECT_TRUE(meeting.looks_inwards);
  EXPECT_NEAR(glm::distance(meeting.point, glm::dvec3(0, 0, 0.3)), 0, 1e-9);
  EXPECT_NEAR(meeting.distance, std::hypot(3, 1.2), 1e-9);
  EXPECT_EQ(meeting.in_front, 8u);
  EXPECT_GT(meeting.turn, 120);
  EXPECT_FALSE(meeting_of_axes(parallel).looks_inwards);
}

}  // namespace
}  // namespace photohull::pipeline
