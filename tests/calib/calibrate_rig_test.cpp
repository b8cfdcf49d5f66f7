// Rigs of rendered boards and of computed points.
#include "calib/calibrate_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "rendered_boards.h"

namespace photohull {
namespace {

using testing::HasSubstr;

constexpr int kMoments = 12;
constexpr double kDistance = 13;

/// Three cameras of different lenses that look at the same place from 14 degrees apart.
struct Rig {
  std::vector<Truth> lenses{3};
  std::vector<Pose> cam_from_rig{3};

  Rig() {
    lenses[1].k = {640, 480, 655, 655, 0, 315, 245};
    lenses[1].lens = {DistortionModel::kBrown, {0.06, -0.02, 0, 0, 0, 0, 0, 0}};
    lenses[2].k = {640, 480, 590, 592, 0, 322, 236};
    for (int c = 1; c < 3; ++c) {
      const glm::dvec3 about(0, 0, kDistance);
      const glm::dmat3 turn = glm::mat3_cast(glm::angleAxis(
          14 * kRadian, glm::normalize(c == 1 ? glm::dvec3(0, 1, 0.1) : glm::dvec3(1, -0.3, 0))));
      cam_from_rig[c] = {turn, about - turn * about + glm::dvec3(0.05 * c, -0.1, 0.2)};
    }
  }

  Pose board_in(int camera, int moment) const {
    const Pose board = pose_of(moment, {4, 2.5}, kDistance);
    const Pose& p = cam_from_rig[camera];
    return {p.rotation * board.rotation, p.rotation * board.translation + p.translation};
  }

  std::vector<RigCameraViews> exact() const {
    std::vector<RigCameraViews> views;
    for (int c = 0; c < 3; ++c) {
      std::vector<Pose> poses;
      for (int m = 0; m < kMoments; ++m) poses.push_back(board_in(c, m));
      views.push_back({concat("cam", c), exact_views(lenses[c], poses)});
    }
    return views;
  }
};

double angle_between(const glm::dmat3& a, const glm::dmat3& b) {
  const glm::dmat3 r = glm::transpose(a) * b;
  const glm::dvec3 odd(r[1][2] - r[2][1], r[2][0] - r[0][2], r[0][1] - r[1][0]);
  return std::asin(std::min(1.0, 0.5 * glm::length(odd))) / kRadian;
}

glm::dvec3 center_of(const Pose& p) { return -(glm::transpose(p.rotation) * p.translation); }

void forget(BoardView& view) {
  view.points.clear();
  view.pixels.clear();
}

TEST(CalibrateRig, RenderedBoardsGiveLensesAndPoses) {
  const Rig rig;
  const BoardSpec spec{BoardKind::kChess, 9, 6, 1};
  std::vector<RigCameraViews> cameras;
  for (int c = 0; c < 3; ++c) {
    cameras.push_back({concat("cam", c), {}});
    for (int m = 0; m < 8; ++m)
      cameras[c].views.push_back(find_board(
          photograph(rig.lenses[c], rig.board_in(c, m), chess(9, 6)), spec, concat(c, "/", m)));
  }
  const RigCalibration found = calibrate_rig(cameras, LensModel::kBrown);
  ASSERT_EQ(found.cameras.size(), 3u);
  EXPECT_LT(found.all_rms, 0.1);
  for (int c = 0; c < 3; ++c) {
    const RigCamera& camera = found.cameras[c];
    const Intrinsics &k = camera.intrinsics, &truth = rig.lenses[c].k;
    EXPECT_NEAR(k.fx / truth.fx, 1, 1e-3) << c;
    EXPECT_NEAR(k.fy / truth.fy, 1, 1e-3) << c;
    EXPECT_NEAR(k.cx, truth.cx, 0.3) << c;
    EXPECT_NEAR(k.cy, truth.cy, 0.3) << c;
    const double turned = angle_between(camera.cam_from_rig.rotation, rig.cam_from_rig[c].rotation);
    const double moved =
        glm::distance(center_of(camera.cam_from_rig), center_of(rig.cam_from_rig[c]));
    RecordProperty(concat("focal_", c), std::to_string(k.fx / truth.fx - 1));
    RecordProperty(concat("principal_", c),
                   std::to_string(std::hypot(k.cx - truth.cx, k.cy - truth.cy)));
    RecordProperty(concat("degrees_", c), std::to_string(turned));
    RecordProperty(concat("center_", c), std::to_string(moved));
    RecordProperty(concat("degrees_sigma_", c), std::to_string(camera.rotation_sigma));
    RecordProperty(concat("translation_sigma_", c), std::to_string(camera.translation_sigma));
    EXPECT_LT(turned, 0.03) << c;
    EXPECT_LT(moved, 0.001 * kDistance) << c;
    EXPECT_GT(camera.focal_sigma, 0) << c;
    EXPECT_EQ(camera.rotation_sigma > 0, c > 0) << c;
    EXPECT_EQ(camera.translation_sigma > 0, c > 0) << c;
  }
}

TEST(CalibrateRig, ExactPointsGiveExactPoses) {
  const Rig rig;
  std::vector<RigCameraViews> cameras = rig.exact();
  // The third never shares a moment with the first, only with the second.
  for (int m = 0; m < kMoments; ++m) forget(cameras[m < 6 ? 0 : 2].views[m]);
  const RigCalibration found = calibrate_rig(cameras, LensModel::kBrown);
  for (int c = 0; c < 3; ++c) {
    EXPECT_LT(angle_between(found.cameras[c].cam_from_rig.rotation, rig.cam_from_rig[c].rotation),
              1e-4);
    EXPECT_LT(
        glm::distance(found.cameras[c].cam_from_rig.translation, rig.cam_from_rig[c].translation),
        1e-4);
    for (int m = 0; m < kMoments; ++m)
      EXPECT_EQ(found.cameras[c].left_out[m], cameras[c].views[m].points.empty()) << c << " " << m;
  }
  for (int m = 0; m < kMoments; ++m)
    EXPECT_LT(glm::distance(found.rig_from_board[m].translation,
                            pose_of(m, {4, 2.5}, kDistance).translation),
              1e-3);
}

TEST(CalibrateRig, PicturesThatWereTakenLaterAreNamed) {
  const Rig rig;
  std::vector<RigCameraViews> cameras = rig.exact();
  // The second camera's fifth picture is sharp and right, but of a board that has moved on.
  Pose later = rig.board_in(1, 5);
  later.translation += glm::dvec3(0.4, -0.2, 0.1);
  cameras[1].views[5] = exact_views(rig.lenses[1], {later})[0];
  const RigCalibration found = calibrate_rig(cameras, LensModel::kBrown);
  for (int c = 0; c < 3; ++c)
    for (int m = 0; m < kMoments; ++m)
      EXPECT_EQ(found.cameras[c].left_out[m], c == 1 && m == 5) << c << " " << m;
  EXPECT_GT(found.cameras[1].rms[5], 5);
  EXPECT_LT(angle_between(found.cameras[1].cam_from_rig.rotation, rig.cam_from_rig[1].rotation),
            1e-4);
}

TEST(CalibrateRig, NoiseIsWhatTheStandardDeviationsSay) {
  const Rig rig;
  std::vector<RigCameraViews> cameras = rig.exact();
  unsigned state = 1;
  const auto uniform = [&] { return (state = state * 1664525u + 1013904223u) / 4294967296.0; };
  for (RigCameraViews& camera : cameras)
    for (BoardView& view : camera.views)
      for (glm::dvec2& p : view.pixels)
        for (int i = 0; i < 2; ++i)
          p[i] += 0.2 * (uniform() + uniform() + uniform() + uniform() - 2) * std::sqrt(3.0);
  const RigCalibration found = calibrate_rig(cameras, LensModel::kBrown);
  EXPECT_NEAR(found.all_rms, 0.2 * std::sqrt(2.0), 0.02);
  for (int c = 0; c < 3; ++c) {
    const RigCamera& camera = found.cameras[c];
    EXPECT_LT(std::abs(camera.intrinsics.fx - rig.lenses[c].k.fx), 4 * camera.focal_sigma) << c;
    EXPECT_LT(std::abs(camera.intrinsics.cx - rig.lenses[c].k.cx), 4 * camera.principal_sigma) << c;
    if (c == 0) continue;
    const double turned = angle_between(camera.cam_from_rig.rotation, rig.cam_from_rig[c].rotation);
    EXPECT_LT(turned, 4 * camera.rotation_sigma) << c;
    EXPECT_GT(turned, 0.02 * camera.rotation_sigma) << c;
    EXPECT_LT(glm::distance(camera.cam_from_rig.translation, rig.cam_from_rig[c].translation),
              6 * camera.translation_sigma)
        << c;
  }
}

TEST(CalibrateRig, CamerasThatShareNothingAreNamed) {
  std::vector<RigCameraViews> cameras = Rig().exact();
  for (int m = 0; m < kMoments; ++m) {
    forget(cameras[2].views[m < 6 ? m : 0]);
    if (m >= 6) forget(cameras[0].views[m]), forget(cameras[1].views[m]);
  }
  const auto message = [&] {
    try {
      calibrate_rig(cameras, LensModel::kBrown);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message(), HasSubstr("camera cam2 never sees the board at the same moment as cam0"));
  for (BoardView& view : cameras[1].views) forget(view);
  EXPECT_THAT(message(), HasSubstr("camera cam1: the board was found in 0 of 12 pictures"));
  EXPECT_THROW(calibrate_rig({cameras[0]}, LensModel::kBrown), UsageError);
}

}  // namespace
}  // namespace photohull
