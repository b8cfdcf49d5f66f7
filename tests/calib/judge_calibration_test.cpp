// Calibrations that cannot be right, or tell too little, against those that serve.
#include "calib/judge_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/error.h"
#include "rendered_boards.h"

namespace photohull {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// As corners are found in photographs.
std::vector<BoardView> noisy(std::vector<BoardView> views, double sigma = 0.1) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0, sigma);
  for (BoardView& view : views)
    for (glm::dvec2& p : view.pixels) p += glm::dvec2(normal(random), normal(random));
  return views;
}

std::vector<Pose> tilted(int count, double distance = 13) {
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) poses.push_back(pose_of(i, {4, 2.5}, distance));
  return poses;
}

/// A board on a table at these degrees, its normal leaning from the axis by `lean` degrees.
std::vector<Pose> on_table(double lean) {
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.02, -0.8, -0.6)), point(0, 0, 13);
  // The board's z along the axis, then leant.
  const glm::dvec3 x = glm::normalize(glm::cross(axis, glm::dvec3(0, 0, 1)));
  const glm::dmat3 flat(x, glm::cross(axis, x), axis);
  std::vector<Pose> poses;
  for (int i = 0; i < 12; ++i) {
    const glm::dmat3 r = glm::mat3_cast(glm::angleAxis(30 * i * kRadian, axis)) *
                         glm::mat3_cast(glm::angleAxis(lean * kRadian, x)) * flat;
    poses.push_back({r, point - r * glm::dvec3(4, 2.5, 0)});
  }
  return poses;
}

Calibration on_turntable(const std::vector<BoardView>& views, const Truth* known = nullptr) {
  CalibrateOptions options;
  options.turntable = true;
  for (std::size_t i = 0; i < views.size(); ++i) options.angles.push_back(30.0 * double(i));
  if (known) options.known = KnownLens{known->k, known->lens};
  return calibrate(views, options);
}

TEST(JudgeCalibration, BoardsTiltedToAllSidesServe) {
  const auto views = noisy(exact_views({}, tilted(12)));
  const Calibration c = calibrate(views, {});
  RecordProperty("object_error", std::to_string(c.object_error));
  EXPECT_GT(c.object_error, 0.005);
  EXPECT_LT(c.object_error, 0.3);
  const CalibrationJudgement judged = judge_calibration(views, c);
  EXPECT_EQ(judged.refusal, "");
  EXPECT_THAT(judged.doubts, IsEmpty());
  EXPECT_FALSE(judged.misfits);
}

TEST(JudgeCalibration, TheErrorAtTheObjectIsWhatNewNoiseDoesToIt) {
  // The same boards calibrated under many noises: how far places beside the board are seen from
  // where the truth sees them, against the deviation that one of them states.
  const Truth truth;
  const auto exact = exact_views(truth, tilted(8));
  double said = 0, squares = 0;
  constexpr int kNoises = 12;
  std::mt19937 random(3);
  std::normal_distribution<double> normal(0, 0.2);
  for (int n = 0; n < kNoises; ++n) {
    auto views = exact;
    for (BoardView& view : views)
      for (glm::dvec2& p : view.pixels) p += glm::dvec2(normal(random), normal(random));
    const Calibration c = calibrate(views, {});
    said += c.object_error / kNoises;
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < views.size(); ++i)
      for (int k = 0; k < 64; ++k) {
        const glm::dvec3 place =
            glm::dvec3(0, -1.5, -4) + 8.0 / 3 * glm::dvec3(k % 4, k / 4 % 4, k / 16);
        const auto imaged = [&](const Intrinsics& lens, const Distortion& distortion,
                                const Pose& pose) {
          const glm::dvec3 p = pose.rotation * place + pose.translation;
          const glm::dvec2 q = distort(distortion, glm::dvec2(p) / p.z);
          return glm::dvec2(lens.fx * q.x + lens.cx, lens.fy * q.y + lens.cy);
        };
        const glm::dvec2 right = imaged(truth.k, truth.lens, tilted(8)[i]);
        if (right.x < 0 || right.y < 0 || right.x > 639 || right.y > 479) continue;
        const glm::dvec2 off = imaged(c.intrinsics, c.distortion, c.cam_from_board[i]) - right;
        sum += glm::dot(off, off), ++count;
      }
    squares += sum / count / kNoises;
  }
  RecordProperty("said", std::to_string(said));
  RecordProperty("is", std::to_string(std::sqrt(squares)));
  // The world may move in what is said, and does little in what is.
  EXPECT_NEAR(said / std::sqrt(squares), 0.85, 0.2);
}

TEST(JudgeCalibration, BoardsThatAllFaceTheCameraTellTooLittle) {
  std::vector<Pose> poses;
  for (int i = 0; i < 8; ++i) {
    Pose pose;
    pose.translation = {-4 + 0.4 * (i % 3), -2.5 + 0.3 * (i % 4), 12 + 0.2 * i};
    poses.push_back(pose);
  }
  const auto views = noisy(exact_views({}, poses));
  CalibrationJudgement judged;
  try {
    judged = judge_calibration(views, calibrate(views, {}));
  } catch (const Error& error) {  // OpenCV may find nothing at all
    judged.refusal = error.what();
  }
  EXPECT_THAT(judged.refusal, HasSubstr("tilted"));
}

TEST(JudgeCalibration, ABoardThatLiesFlatOnTheTableIsRefused) {
  const auto views = noisy(exact_views({}, on_table(0)), 0.3);
  const Calibration c = on_turntable(views);
  RecordProperty("object_error", std::to_string(c.object_error));
  const CalibrationJudgement judged = judge_calibration(views, c);
  EXPECT_THAT(judged.refusal, HasSubstr("lean the board on the table"));
  EXPECT_THAT(judged.refusal, HasSubstr("with lens_from"));
}

TEST(JudgeCalibration, ABoardThatLeansOnTheTableServes) {
  Truth plain;  // the half of the turn that shows the board's face
  auto poses = on_table(40);
  const auto views = noisy(exact_views(plain, poses), 0.1);
  const Calibration c = on_turntable(views);
  RecordProperty("object_error", std::to_string(c.object_error));
  EXPECT_EQ(judge_calibration(views, c).refusal, "");
}

TEST(JudgeCalibration, AKnownLensMakesTheFlatBoardServe) {
  const Truth truth;
  const auto views = noisy(exact_views(truth, on_table(0)), 0.3);
  const Calibration c = on_turntable(views, &truth);
  RecordProperty("object_error", std::to_string(c.object_error));
  EXPECT_EQ(c.intrinsics.fx, truth.k.fx);
  EXPECT_EQ(c.distortion.coefficients, truth.lens.coefficients);
  EXPECT_TRUE(c.lens_known);
  EXPECT_EQ(c.focal_sigma, 0);
  const glm::dvec3 axis = glm::normalize(glm::dvec3(0.02, -0.8, -0.6));
  EXPECT_LT(std::acos(std::min(1.0, glm::dot(c.turntable->direction, axis))) / kRadian, 0.1);
  const CalibrationJudgement judged = judge_calibration(views, c);
  EXPECT_EQ(judged.refusal, "");
  EXPECT_THAT(judged.doubts, IsEmpty());
}

TEST(JudgeCalibration, AKnownLensGivesThePosesOfSingleBoards) {
  Truth truth;
  for (const auto& lens :
       {Distortion{DistortionModel::kBrown, {-0.12, 0.05, 0.001, -0.0008}},
        Distortion{DistortionModel::kFisheye, {0.02, -0.01, 0.003, -0.001}}, Distortion{}}) {
    truth.lens = lens;
    const auto poses = tilted(1);
    CalibrateOptions options;
    options.known = KnownLens{truth.k, lens};
    const Calibration c = calibrate(exact_views(truth, poses), options);
    EXPECT_LT(c.all_rms, 1e-4);
    EXPECT_LT(glm::distance(c.cam_from_board[0].translation, poses[0].translation), 1e-4);
  }
  KnownLens skewed{truth.k, {}};
  skewed.intrinsics.skew = 3;
  CalibrateOptions options;
  options.known = skewed;
  EXPECT_THROW(calibrate(exact_views(truth, tilted(3)), options), Error);
}

class JudgeNumbers : public testing::Test {
 protected:
  JudgeNumbers() : views_(exact_views({}, tilted(10))), c_(calibrate(views_, {})) {}
  std::string refusal() const { return judge_calibration(views_, c_).refusal; }
  std::string doubts() const {
    std::string all;
    for (const std::string& text : judge_calibration(views_, c_).doubts) all += text + "\n";
    return all;
  }
  std::vector<BoardView> views_;
  Calibration c_;
};

TEST_F(JudgeNumbers, LensesThatNoCameraHasAreRefused) {
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(doubts(), "");
  const Intrinsics good = c_.intrinsics;
  c_.intrinsics.fx = c_.intrinsics.fy = -0.337;
  EXPECT_THAT(refusal(), HasSubstr("-0.337"));
  c_.intrinsics.fx = c_.intrinsics.fy = 1e6;
  EXPECT_THAT(refusal(), HasSubstr("no lens has"));
  c_.intrinsics = good;
  c_.intrinsics.fy = good.fx / 3;
  EXPECT_THAT(refusal(), HasSubstr("nearly square"));
  c_.intrinsics.fy = good.fx / 1.1;
  EXPECT_EQ(refusal(), "");
  EXPECT_THAT(doubts(), HasSubstr("not square"));
  c_.intrinsics = good;
  c_.intrinsics.cx = -30;
  EXPECT_THAT(refusal(), HasSubstr("not in the picture"));
  c_.intrinsics.cx = 100;
  EXPECT_EQ(refusal(), "");
  EXPECT_THAT(doubts(), HasSubstr("far from the middle"));
  c_.intrinsics.fx = NAN;
  EXPECT_THAT(refusal(), HasSubstr("no camera has"));
}

TEST_F(JudgeNumbers, PoorFitsAndUncertaintyAreDoubtfulThenRefused) {
  c_.all_rms = 0.6;
  EXPECT_EQ(refusal(), "");
  EXPECT_THAT(doubts(), HasSubstr("0.6 px rms"));
  EXPECT_TRUE(judge_calibration(views_, c_).misfits);
  c_.all_rms = 51;
  EXPECT_THAT(refusal(), HasSubstr("51 px rms"));
  // Pixels of large pictures are smaller.
  c_.all_rms = 3;
  EXPECT_THAT(refusal(), Not(IsEmpty()));
  const Intrinsics small = c_.intrinsics;
  c_.intrinsics = {6000, 4000, 5700, 5700, 0, 3000, 2000};
  EXPECT_EQ(refusal(), "");
  c_.intrinsics = small;
  c_.all_rms = 0.1;
  c_.object_error = 0.7;
  EXPECT_EQ(refusal(), "");
  EXPECT_THAT(doubts(), HasSubstr("0.7 px only where an object would stand"));
  c_.object_error = 30;
  EXPECT_THAT(refusal(), HasSubstr("tilted by 30 to 45 degrees"));
  c_.object_error = INFINITY;
  EXPECT_THAT(refusal(), HasSubstr("undetermined"));
}

TEST_F(JudgeNumbers, MostBoardsLeftOutAreDoubtful) {
  for (std::size_t i = 0; i < 6; ++i) c_.left_out[i] = true;
  EXPECT_THAT(doubts(), HasSubstr("only 4 of 10"));
}

}  // namespace
}  // namespace photohull
