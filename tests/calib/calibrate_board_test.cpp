// Boards are rendered by rays through a known camera, from pictures of their patterns.
#include "calib/calibrate_board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "rendered_boards.h"

namespace photohull {
namespace {

using testing::HasSubstr;

void expect_truth(const Calibration& c, const Truth& truth) {
  testing::Test::RecordProperty("rms", std::to_string(c.all_rms));
  testing::Test::RecordProperty("sigma", std::to_string(c.principal_sigma));
  testing::Test::RecordProperty("focal", std::to_string(c.intrinsics.fx / truth.k.fx - 1));
  testing::Test::RecordProperty("principal_x", std::to_string(c.intrinsics.cx - truth.k.cx));
  testing::Test::RecordProperty("principal_y", std::to_string(c.intrinsics.cy - truth.k.cy));
  EXPECT_NEAR(c.intrinsics.fx / truth.k.fx, 1, 1e-3);
  EXPECT_NEAR(c.intrinsics.fy / truth.k.fy, 1, 1e-3);
  EXPECT_NEAR(c.intrinsics.cx, truth.k.cx, 0.3);
  EXPECT_NEAR(c.intrinsics.cy, truth.k.cy, 0.3);
}

TEST(CalibrateBoard, ChessboardsGiveTheRenderedCamera) {
  const Truth truth;
  const BoardSpec spec{BoardKind::kChess, 9, 6, 1};
  const auto views = photographs(truth, spec, chess(9, 6), {4, 2.5}, 16, 13);
  const Calibration c = calibrate(views, {});
  expect_truth(c, truth);
  EXPECT_LT(c.all_rms, 0.1);
  EXPECT_GT(c.focal_sigma, 0);
  EXPECT_LT(c.focal_sigma, 1);
  // Boards that the frame cuts are not found; all others count.
  int found = 0;
  for (int i = 0; i < 16; ++i) {
    EXPECT_EQ(c.left_out[i], views[i].points.empty()) << i;
    found += !views[i].points.empty();
  }
  EXPECT_GE(found, 12);
  const ColourImage covered = coverage_picture(views, c);
  EXPECT_EQ(covered.width, 640);
  EXPECT_GT(covered.linear(320, 240).r, 0.9f);
  EXPECT_EQ(covered.linear(0, 0).r, 0.0f);
}

TEST(CalibrateBoard, CharucoBoardsGiveTheRenderedCamera) {
  const Truth truth;
  const BoardSpec spec{BoardKind::kCharuco, 8, 6, 1, 0.75, 0};
  const Calibration c = calibrate(photographs(truth, spec, charuco(8, 6), {4, 3}, 24, 9), {});
  expect_truth(c, truth);
}

TEST(CalibrateBoard, CirclesGiveTheRenderedCamera) {
  const Truth truth;
  const BoardSpec spec{BoardKind::kCircles, 8, 6, 1};
  std::vector<BoardView> views = photographs(truth, spec, dots(8, 6), {3.5, 2.5}, 12, 13);
  double worst = 0;
  int found = 0;
  for (const BoardView& view : views) {
    if (view.points.empty()) continue;
    ++found;
    EXPECT_NEAR(view.dot_radius, 0.28, 0.005) << view.name;
  }
  EXPECT_GE(found, 10);
  const Calibration c = calibrate(views, {});
  expect_truth(c, truth);
  EXPECT_LT(c.all_rms, 0.06);
  // As points, the middles of the dots' pictures are off.
  for (BoardView& view : views) view.dot_radius = 0;
  const Calibration biased = calibrate(views, {});
  worst = std::abs(biased.intrinsics.fx / truth.k.fx - 1);
  RecordProperty("focal_without_correction", std::to_string(worst));
  RecordProperty("rms_without_correction", std::to_string(biased.all_rms));
  EXPECT_GT(biased.all_rms, c.all_rms);
}

TEST(CalibrateBoard, OutliersAreLeftOutAndNamed) {
  const Truth truth;
  std::vector<Pose> poses;
  for (int i = 0; i < 9; ++i) poses.push_back(pose_of(i, {4, 2.5}, 12));
  auto views = exact_views(truth, poses);
  for (int k = 0; k < 54; ++k)
    views[4].pixels[k] += glm::dvec2(3 * std::sin(7.0 * k), 3 * std::cos(5.0 * k));
  const Calibration c = calibrate(views, {});
  for (int i = 0; i < 9; ++i) EXPECT_EQ(c.left_out[i], i == 4) << i;
  EXPECT_GT(c.rms[4], 1);
  EXPECT_NEAR(c.intrinsics.fx, truth.k.fx, 1e-3);
  EXPECT_NEAR(c.distortion.coefficients[0], -0.12, 1e-5);
}

TEST(CalibrateBoard, FisheyeAndRationalLenses) {
  Truth truth;
  std::vector<Pose> poses;
  for (int i = 0; i < 10; ++i) poses.push_back(pose_of(i, {4, 2.5}, 9));
  truth.lens = {DistortionModel::kFisheye, {0.02, -0.01, 0.003, -0.001}};
  CalibrateOptions options;
  options.lens = LensModel::kFisheye;
  const Calibration fisheye = calibrate(exact_views(truth, poses), options);
  EXPECT_EQ(fisheye.distortion.model, DistortionModel::kFisheye);
  EXPECT_NEAR(fisheye.intrinsics.fx, truth.k.fx, 0.05);
  options.lens = LensModel::kRational;
  truth.lens = {DistortionModel::kBrown, {0.1, 0.02, 0.001, 0.002, 0.01, 0.15, 0.01, 0}};
  const Calibration rational = calibrate(exact_views(truth, poses), options);
  EXPECT_LT(rational.all_rms, 1e-3);
  EXPECT_NEAR(rational.intrinsics.fx, truth.k.fx, 0.5);
}

TEST(CalibrateBoard, TurntablesAxisAndAngles) {
  const Truth truth;
  const BoardSpec spec{BoardKind::kChess, 9, 6, 1};
  // The board lies tilted on the table, whose axis leans towards the camera.
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.1, -0.9, -0.4)), point(0.5, 1, 13);
  Pose first = pose_of(1, {4, 2.5}, 13);
  std::vector<BoardView> views;
  std::vector<double> angles;
  for (int i = 0; i < 9; ++i) {
    angles.push_back(7.5 * i - (i ? 30 : 0));
    const glm::dmat3 turn = glm::mat3_cast(glm::angleAxis(angles.back() * kRadian, axis));
    const Pose pose{turn * first.rotation, turn * (first.translation - point) + point};
    views.push_back(find_board(photograph(truth, pose, chess(9, 6)), spec, concat("view ", i)));
  }
  CalibrateOptions options;
  options.turntable = true;
  const Calibration c = calibrate(views, options);
  ASSERT_TRUE(c.turntable);
  const double sign = glm::dot(c.turntable->direction, axis) > 0 ? 1 : -1;
  const double off = std::acos(std::min(1.0, sign * glm::dot(c.turntable->direction, axis)));
  RecordProperty("axis_degrees", std::to_string(off / kRadian));
  EXPECT_LT(off / kRadian, 0.02);
  for (int i = 0; i < 9; ++i) {
    ASSERT_FALSE(c.left_out[i]) << i;
    EXPECT_NEAR(sign * c.turntable->angles[i], angles[i], 0.05) << i;
  }
  EXPECT_GT(c.turntable->direction_sigma, 0);
  EXPECT_LT(c.turntable->direction_sigma, 0.05);
}

/// Poses of a board on a table that stands at these degrees.
std::vector<Pose> on_table(const Pose& at_zero, const glm::dvec3& axis, const glm::dvec3& point,
                           const std::vector<double>& degrees) {
  std::vector<Pose> poses;
  for (const double angle : degrees) {
    const glm::dmat3 turn = glm::mat3_cast(glm::angleAxis(angle * kRadian, axis));
    poses.push_back({turn * at_zero.rotation, turn * (at_zero.translation - point) + point});
  }
  return poses;
}

class Turntable : public testing::Test {
 protected:
  const Truth truth_{};
  const glm::dvec3 axis_ = glm::normalize(glm::dvec3(0.1, -0.9, -0.4)), point_{0.5, 1, 13};
  const Pose first_ = pose_of(1, {4, 2.5}, 13);

  double axis_error(const Calibration& c) const {
    return std::acos(std::min(1.0, glm::dot(c.turntable->direction, axis_))) / kRadian;
  }
  /// Distance of the axis found from the true one.
  double point_error(const Calibration& c) const {
    return glm::length(glm::cross(c.turntable->point - point_, axis_));
  }
};

TEST_F(Turntable, GivenAnglesGiveTheRenderedAxis) {
  const BoardSpec spec{BoardKind::kChess, 9, 6, 1};
  CalibrateOptions options;
  options.turntable = true;
  for (int i = 0; i < 9; ++i) options.angles.push_back(100 + 7.5 * (i - 4));
  std::vector<double> turned = options.angles;
  for (double& angle : turned) angle -= 100;
  std::vector<BoardView> views;
  for (const Pose& pose : on_table(first_, axis_, point_, turned))
    views.push_back(
        find_board(photograph(truth_, pose, chess(9, 6)), spec, concat("view ", views.size())));
  const Calibration c = calibrate(views, options);
  ASSERT_TRUE(c.turntable);
  RecordProperty("axis_degrees", std::to_string(axis_error(c)));
  RecordProperty("axis_sigma", std::to_string(c.turntable->direction_sigma));
  RecordProperty("axis_place", std::to_string(point_error(c)));
  EXPECT_LT(axis_error(c), 0.02);
  EXPECT_LT(point_error(c), 0.01);
  EXPECT_GT(c.turntable->direction_sigma, 0);
  EXPECT_GT(c.turntable->point_sigma, 0);
  EXPECT_EQ(c.turntable->angle_sigma, 0);
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(c.turntable->angles[i], options.angles[i], 1e-9);
}

TEST_F(Turntable, AViewAtAnotherAngleThanStatedIsNamed) {
  std::vector<double> angles;
  for (int i = 0; i < 12; ++i) angles.push_back(10.0 * i - 55);
  CalibrateOptions options;
  options.turntable = true;
  options.angles = angles;
  angles[7] += 1.5;
  const Calibration c =
      calibrate(exact_views(truth_, on_table(first_, axis_, point_, angles)), options);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(c.left_out[i], i == 7) << i;
  EXPECT_GT(c.rms[7], 1.5);
  EXPECT_LT(axis_error(c), 1e-4);
  EXPECT_LT(point_error(c), 1e-4);
}

TEST_F(Turntable, FullTurnsAtGivenAnglesAreUnderstood) {
  // Only some of a full turn shows the board; what does is told by the others' angles.
  const std::vector<double> angles = {-20, 5, 340, 361, 375, 25};
  CalibrateOptions options;
  options.turntable = true;
  options.angles = angles;
  const Calibration c =
      calibrate(exact_views(truth_, on_table(first_, axis_, point_, angles)), options);
  EXPECT_LT(axis_error(c), 1e-4);
  EXPECT_LT(c.all_rms, 1e-4);
}

TEST_F(Turntable, WrongAnglesAreRefused) {
  std::vector<double> angles;
  for (int i = 0; i < 9; ++i) angles.push_back(10.0 * i - 40);
  const std::vector<BoardView> views = exact_views(truth_, on_table(first_, axis_, point_, angles));
  CalibrateOptions options;
  options.turntable = true;
  for (const double angle : angles) options.angles.push_back(1.2 * angle);
  try {
    calibrate(views, options);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("the stated angles do not fit"));
  }
  options.angles.pop_back();
  EXPECT_THROW(calibrate(views, options), UsageError);
  options.angles = angles;
  options.turntable = false;
  EXPECT_THROW(calibrate(views, options), UsageError);
}

TEST(CalibrateBoard, TooFewBoardsAndMixedSizesAreRefused) {
  const Truth truth;
  auto views = exact_views(
      truth, {pose_of(0, {4, 2.5}, 12), pose_of(1, {4, 2.5}, 12), pose_of(2, {4, 2.5}, 12)});
  views[2].width = 320;
  try {
    calibrate(views, {});
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("view 2: the picture is of another size"));
  }
  views.pop_back();
  EXPECT_THROW(calibrate(views, {}), Error);
  EXPECT_THROW((BoardSpec{BoardKind::kChess, 2, 6}.validate()), UsageError);
}

}  // namespace
}  // namespace photohull
