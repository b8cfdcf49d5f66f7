#include "synth/degrade_cameras.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/box.h"
#include "synth/place_cameras.h"

namespace photohull::synth {
namespace {

class CameraErrors : public testing::Test {
 protected:
  CameraErrors() {
    const Spec spec = parse_spec(R"({"geometry": {"shape": "block"}})", "test", "");
    const Surface surface = make_surface(spec.geometry);
    cameras_ = place_cameras(spec, surface);
    for (std::size_t i = 0; i < surface.mesh.positions.size(); ++i)
      points_.push_back(surface.mesh.world(i));
  }
  std::vector<LensCamera> cameras_;
  std::vector<glm::dvec3> points_;
};

TEST_F(CameraErrors, PosesAreOffByThePixelsAskedFor) {
  for (const double pixels : {0.25, 2.0, 10.0}) {
    DegradationSpec spec;
    spec.pose_error = pixels;
    const auto off = degrade_cameras(cameras_, spec, 3, points_);
    EXPECT_NEAR(reprojection_error(cameras_, off, points_), pixels, 1e-6);
    for (std::size_t i = 0; i < off.size(); ++i) {
      const glm::dmat3 r = off[i].camera.cam_from_world.rotation;
      EXPECT_NEAR(determinant(r), 1, 1e-12);
      EXPECT_EQ(off[i].camera.intrinsics.fx, cameras_[i].camera.intrinsics.fx);
    }
  }
}

TEST_F(CameraErrors, IntrinsicsAreOffByThePixelsAskedForAndAlikeInAllViews) {
  DegradationSpec spec;
  spec.intrinsics_error = 1.5;
  const auto off = degrade_cameras(cameras_, spec, 3, points_);
  EXPECT_NEAR(reprojection_error(cameras_, off, points_), 1.5, 1e-6);
  for (const LensCamera& lens : off) {
    EXPECT_EQ(lens.camera.intrinsics.fx, off[0].camera.intrinsics.fx);
    EXPECT_EQ(lens.camera.intrinsics.cx, off[0].camera.intrinsics.cx);
  }
  EXPECT_EQ(off[5].camera.cam_from_world.translation,
            cameras_[5].camera.cam_from_world.translation);
}

TEST_F(CameraErrors, WrongViewsAreTurnedAboutTheMiddleAndNoOtherView) {
  DegradationSpec spec;
  spec.wrong_views = 0.25, spec.wrong_turn = 40;
  ASSERT_EQ(cameras_.size(), 36u);
  const auto off = degrade_cameras(cameras_, spec, 3, points_);
  Box box{points_.front(), points_.front()};
  for (const glm::dvec3& p : points_) box.min = min(box.min, p), box.max = max(box.max, p);
  int wrong = 0;
  for (std::size_t i = 0; i < off.size(); ++i) {
    const glm::dmat3 turn = transpose(cameras_[i].camera.cam_from_world.rotation) *
                            off[i].camera.cam_from_world.rotation;
    const double degrees = glm::degrees(
        std::acos(std::clamp((turn[0][0] + turn[1][1] + turn[2][2] - 1) / 2, -1.0, 1.0)));
    if (degrees < 1e-3) continue;
    ++wrong;
    EXPECT_NEAR(degrees, 40, 1e-6);
    EXPECT_LT(length(*off[i].project(box.center()) - *cameras_[i].project(box.center())), 1e-6);
  }
  EXPECT_EQ(wrong, 9);
  EXPECT_TRUE(cameras_are_off(spec));
}

TEST_F(CameraErrors, AShareOfTheViewsIsShiftedByThePixelsAskedFor) {
  DegradationSpec spec;
  spec.view_shift = 2;
  EXPECT_FALSE(cameras_are_off(spec));  // no views
  for (const auto& [share, expected] :
       {std::pair{0.0, 0}, {0.001, 1}, {0.25, 9}, {2.0 / 36, 2}, {1.0, 36}}) {
    spec.view_shift_views = share;
    const auto off = degrade_cameras(cameras_, spec, 3, points_);
    int shifted = 0;
    std::vector<glm::dvec2> ways;
    for (std::size_t i = 0; i < off.size(); ++i) {
      EXPECT_EQ(off[i].camera.cam_from_world.translation,
                cameras_[i].camera.cam_from_world.translation);
      const glm::dvec2 way = *off[i].project(points_[0]) - *cameras_[i].project(points_[0]);
      if (length(way) == 0) continue;
      ++shifted;
      ways.push_back(way);
      for (const glm::dvec3& p : points_)
        ASSERT_NEAR(length(*off[i].project(p) - *cameras_[i].project(p)), 2, 1e-9);
    }
    EXPECT_EQ(shifted, expected) << share;
    EXPECT_EQ(cameras_are_off(spec), share > 0);
    if (expected > 1) {
      EXPECT_GT(length(ways[0] - ways[1]), 1e-3);  // each in a direction of its own
    }
  }
}

TEST_F(CameraErrors, PrincipalPointsShiftAndDistortionIsForgotten) {
  for (LensCamera& lens : cameras_) lens.distortion = {DistortionModel::kBrown, {0.1, 0, 0, 0}};
  DegradationSpec spec;
  spec.pixel_shift = {0.5, -2};
  spec.ignore_distortion = true;
  const auto off = degrade_cameras(cameras_, spec, 3, points_);
  for (std::size_t i = 0; i < off.size(); ++i) {
    EXPECT_EQ(off[i].camera.intrinsics.cx, cameras_[i].camera.intrinsics.cx + 0.5);
    EXPECT_EQ(off[i].camera.intrinsics.cy, cameras_[i].camera.intrinsics.cy - 2);
    EXPECT_EQ(off[i].distortion.model, DistortionModel::kNone);
  }
}

TEST_F(CameraErrors, NoneLeavesThemAlone) {
  EXPECT_FALSE(cameras_are_off({}));
  EXPECT_EQ(reprojection_error(cameras_, degrade_cameras(cameras_, {}, 3, points_), points_), 0);
}

}  // namespace
}  // namespace photohull::synth
