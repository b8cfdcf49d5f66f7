// Boards are rendered by rays through a known camera, from pictures of their patterns.
#include "calib/calibrate_board.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <numbers>
#include <opencv2/aruco/charuco.hpp>

#include "calib/undistort.h"
#include "core/error.h"
#include "pictures.h"

namespace photohull {
namespace {

using testing::HasSubstr;

constexpr double kRadian = std::numbers::pi / 180;

/// Brightness of a board at a place in its plane.
using Pattern = std::function<double(double x, double y)>;

/// Squares of side 1 with the first inner corner at (0, 0), a white rim around columns + 1 by
/// rows + 1 of them.
Pattern chess(int columns, int rows) {
  return [=](double x, double y) {
    if (x < -1 || y < -1 || x > columns || y > rows) return 0.9;
    return (int(std::floor(x)) + int(std::floor(y))) & 1 ? 0.05 : 0.9;
  };
}

Pattern dots(int columns, int rows) {
  return [=](double x, double y) {
    const double i = std::clamp(std::round(x), 0.0, columns - 1.0);
    const double j = std::clamp(std::round(y), 0.0, rows - 1.0);
    return std::hypot(x - i, y - j) < 0.28 ? 0.05 : 0.9;
  };
}

/// OpenCV's drawing, a hundred pixels a square; its corner 0 is at (1, 1).
Pattern charuco(int columns, int rows) {
  constexpr int kSquare = 100;
  const auto board = cv::aruco::CharucoBoard::create(columns, rows, 1.0f, 0.75f,
                                                     cv::aruco::getPredefinedDictionary(0));
  cv::Mat drawn;
  board->draw({columns * kSquare, rows * kSquare}, drawn, 0);
  return [=](double x, double y) {
    const int i = int(std::floor(x * kSquare)), j = int(std::floor(y * kSquare));
    if (i < 0 || j < 0 || i >= drawn.cols || j >= drawn.rows) return 0.9;
    return drawn.at<std::uint8_t>(j, i) > 127 ? 0.9 : 0.05;
  };
}

struct Truth {
  Intrinsics k{640, 480, 612.5, 608.0, 0, 326.4, 231.7};
  Distortion lens{DistortionModel::kBrown, {-0.12, 0.05, 0.001, -0.0008, 0, 0, 0, 0}};
};

/// The rays that a lens images at pixel corners, by inverting calib's own distort().
std::vector<glm::dvec2> corner_rays(const Truth& truth) {
  std::vector<glm::dvec2> rays;
  for (int y = 0; y <= truth.k.height; ++y)
    for (int x = 0; x <= truth.k.width; ++x) {
      const glm::dvec2 target((x - 0.5 - truth.k.cx) / truth.k.fx,
                              (y - 0.5 - truth.k.cy) / truth.k.fy);
      glm::dvec2 q = target;
      for (int step = 0; step < 12; ++step) q += target - distort(truth.lens, q);
      rays.push_back(q);
    }
  return rays;
}

ColourImage photograph(const Truth& truth, const Pose& cam_from_board, const Pattern& pattern) {
  const glm::dmat3 back = glm::transpose(cam_from_board.rotation);
  const glm::dvec3 center = -(back * cam_from_board.translation);
  constexpr int kSamples = 4;
  static Truth known;
  static std::vector<glm::dvec2> rays = corner_rays(known);
  if (known.lens.coefficients != truth.lens.coefficients) {
    known = truth;
    rays = corner_rays(known);
  }
  return paint_srgb(truth.k.width, truth.k.height, [&](double x, double y) {
    double sum = 0;
    const glm::dvec2* r = &rays[std::size_t(y) * (truth.k.width + 1) + std::size_t(x)];
    for (int i = 0; i < kSamples * kSamples; ++i) {
      const double s = (i % kSamples + 0.5) / kSamples, t = (i / kSamples + 0.5) / kSamples;
      const glm::dvec2 q = glm::mix(glm::mix(r[0], r[1], s),
                                    glm::mix(r[truth.k.width + 1], r[truth.k.width + 2], s), t);
      const glm::dvec3 d = back * glm::dvec3(q, 1);
      const glm::dvec3 p = center - d * (center.z / d.z);
      sum += pattern(p.x, p.y);
    }
    return glm::vec3(float(sum / (kSamples * kSamples)));
  });
}

/// The board's middle before the camera, tilted in a different way in each of the views.
Pose pose_of(int view, const glm::dvec2& middle, double distance) {
  const double tilt = 22 + 6 * (view % 3), towards = 137.5 * view;
  const glm::dvec3 axis(std::cos(towards * kRadian), std::sin(towards * kRadian), 0);
  const glm::dquat q = glm::angleAxis(tilt * kRadian, axis) *
                       glm::angleAxis(10 * kRadian * (view % 5 - 2), glm::dvec3(0, 0, 1));
  Pose pose;
  pose.rotation = glm::mat3_cast(q);
  const glm::dvec3 aim(0.12 * distance * (view % 3 - 1), 0.08 * distance * (view % 4 - 1.5),
                       distance);
  pose.translation = aim - pose.rotation * glm::dvec3(middle, 0);
  return pose;
}

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

std::vector<BoardView> photographs(const Truth& truth, const BoardSpec& spec,
                                   const Pattern& pattern, const glm::dvec2& middle, int count,
                                   double distance) {
  std::vector<BoardView> views;
  for (int i = 0; i < count; ++i)
    views.push_back(find_board(photograph(truth, pose_of(i, middle, distance), pattern), spec,
                               concat("view ", i)));
  return views;
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

TEST(CalibrateBoard, CirclesServeWithinTheirPerspectiveBias) {
  Truth truth;
  truth.lens = {};
  const BoardSpec spec{BoardKind::kCircles, 8, 6, 1};
  CalibrateOptions pinhole;
  pinhole.lens = LensModel::kPinhole;
  const Calibration c = calibrate(photographs(truth, spec, dots(8, 6), {3.5, 2.5}, 8, 11), pinhole);
  EXPECT_NEAR(c.intrinsics.fx / truth.k.fx, 1, 5e-3);
  EXPECT_NEAR(c.intrinsics.cx, truth.k.cx, 1.5);
}

/// Views whose pixels are computed, not detected.
std::vector<BoardView> exact_views(const Truth& truth, const std::vector<Pose>& poses) {
  std::vector<BoardView> views;
  for (std::size_t n = 0; n < poses.size(); ++n) {
    BoardView view{concat("view ", n), truth.k.width, truth.k.height, {}, {}};
    for (int i = 0; i < 54; ++i) {
      const glm::dvec3 point(i % 9, i / 9, 0);
      const glm::dvec3 p = poses[n].rotation * point + poses[n].translation;
      const glm::dvec2 q = distort(truth.lens, glm::dvec2(p) / p.z);
      view.points.push_back(point);
      view.pixels.emplace_back(truth.k.fx * q.x + truth.k.cx, truth.k.fy * q.y + truth.k.cy);
    }
    views.push_back(view);
  }
  return views;
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
