#include "calib/find_turntable.h"

#include <gmock/gmock.h>

#include <cmath>
#include <random>

namespace photohull {
namespace {

using testing::HasSubstr;

constexpr double kRadian = 0.017453292519943295;

glm::dmat3 about(const glm::dvec3& axis, double degrees) {
  const glm::dvec3 d = glm::normalize(axis);
  const double c = std::cos(degrees * kRadian), s = std::sin(degrees * kRadian);
  const glm::dmat3 cross(0, d.z, -d.y, -d.z, 0, d.x, d.y, -d.x, 0);
  return glm::dmat3(1.0) + s * cross + (1 - c) * cross * cross;
}

/// A camera that looks down at the sheet from `distance` mm.
Pose camera_at(double azimuth, double elevation, double distance) {
  const double a = azimuth * kRadian, e = elevation * kRadian;
  const glm::dvec3 out(std::cos(e) * std::sin(a), -std::cos(e) * std::cos(a), std::sin(e));
  const glm::dvec3 right = glm::normalize(glm::cross(-out, glm::dvec3(0, 0, 1)));
  Pose pose;
  pose.rotation = glm::transpose(glm::dmat3(right, glm::cross(-out, right), -out));
  pose.translation = -(pose.rotation * (distance * out));
  return pose;
}

const glm::dvec3 kAxis = glm::normalize(glm::dvec3(0.02, -0.03, 1));
const glm::dvec3 kPoint(12, -7, 0);  // mm

struct Noise {
  double degrees = 0, length = 0;  ///< deviations of a pose
};

class TurntableTest : public testing::Test {
 protected:
  /// A photograph by a camera whose pose is that where the table has turned by `angle`.
  void take(const Pose& still, double angle, const Noise& noise = {}, int camera = 0) {
    const glm::dmat3 turn = about(kAxis, angle);
    PosedPhoto photo;
    photo.posed = true;
    photo.camera = camera;
    photo.cam_from_world.rotation = still.rotation * turn;
    photo.cam_from_world.translation =
        still.rotation * (kPoint - turn * kPoint) + still.translation;
    disturb(photo.cam_from_world, noise);
    result_.photos.push_back(photo);
    result_.cameras.resize(std::size_t(camera) + 1);
  }

  void take_walking(double azimuth, double elevation, double distance) {
    PosedPhoto photo;
    photo.posed = true;
    photo.cam_from_world = camera_at(azimuth, elevation, distance);
    result_.photos.push_back(photo);
    result_.cameras.resize(1);
  }

  void disturb(Pose& pose, const Noise& noise) {
    const glm::dvec3 axis(normal_(random_), normal_(random_), normal_(random_));
    const glm::dvec3 shift(normal_(random_), normal_(random_), normal_(random_));
    if (noise.degrees > 0)
      pose.rotation = about(axis, noise.degrees * glm::length(axis)) * pose.rotation;
    pose.translation += noise.length * shift;
  }

  double axis_error(const TurntableMotion& found) const {  // degrees
    return std::acos(std::min(1.0, glm::dot(found.direction, kAxis))) / kRadian;
  }

  PoseResult result_;
  std::mt19937 random_{7};
  std::normal_distribution<double> normal_;
};

double angle_between(double a, double b) { return std::abs(std::remainder(a - b, 360)); }

TEST_F(TurntableTest, AxisAndAnglesOfPosesWithNoise) {
  const Pose still = camera_at(40, 30, 500);
  const int count = 24;
  for (int i = 0; i < count; ++i) take(still, 17 + i * 360.0 / count, {0.004, 0.05});
  const TurntableMotion found = find_turntable(result_);
  ASSERT_TRUE(found.found) << found.reason;
  ASSERT_EQ(found.stations.size(), 1u);
  EXPECT_EQ(found.stations[0].photos.size(), std::size_t(count));
  EXPECT_LT(axis_error(found), 0.02);
  EXPECT_LT(glm::length(found.point - kPoint), 0.05);
  for (int i = 0; i < count; ++i)
    EXPECT_LT(angle_between(found.angles[std::size_t(i)], i * 360.0 / count), 0.02) << i;
  // Two of three axes of the noise do not turn about the table's.
  EXPECT_NEAR(found.rms_degrees, 0.004 * std::sqrt(2), 0.003);
  EXPECT_NEAR(found.rms_length, 0.05 * std::sqrt(3), 0.04);
}

TEST_F(TurntableTest, ExactPosesLeaveNothing) {
  const Pose still = camera_at(0, 50, 400);
  for (const double angle : {0.0, 15.0, 75.0, 140.0, 200.0, 300.0}) take(still, angle);
  const TurntableMotion found = find_turntable(result_);
  ASSERT_TRUE(found.found) << found.reason;
  EXPECT_LT(axis_error(found), 1e-5);
  EXPECT_LT(glm::length(found.point - kPoint), 1e-7);
  EXPECT_LT(found.rms_degrees, 1e-6);
  EXPECT_LT(found.rms_length, 1e-8);
  EXPECT_LT(angle_between(found.angles[4], 200), 1e-8);
}

TEST_F(TurntableTest, TwoHeightsAreTwoStations) {
  for (int i = 0; i < 10; ++i) take(camera_at(0, 25, 500), 36 * i, {0.004, 0.05});
  for (int i = 0; i < 7; ++i) take(camera_at(90, 55, 450), 50 * i + 5, {0.004, 0.05}, 1);
  const TurntableMotion found = find_turntable(result_);
  ASSERT_TRUE(found.found) << found.reason;
  ASSERT_EQ(found.stations.size(), 2u);
  EXPECT_EQ(found.stations[0].photos.size(), 10u);
  EXPECT_EQ(found.stations[1].photos.size(), 7u);
  EXPECT_EQ(found.stations[1].camera, 1);
  EXPECT_LT(axis_error(found), 0.02);
  EXPECT_LT(angle_between(found.angles[13], 150), 0.02);
}

TEST_F(TurntableTest, OutliersAreLeftOut) {
  for (int i = 0; i < 12; ++i) take(camera_at(0, 25, 500), 30 * i, {0.004, 0.05});
  take_walking(77, 40, 480);
  take_walking(200, 10, 700);
  result_.photos.push_back({});  // has no pose
  const TurntableMotion found = find_turntable(result_);
  ASSERT_TRUE(found.found) << found.reason;
  EXPECT_EQ(found.stations[0].photos.size(), 12u);
  EXPECT_LT(axis_error(found), 0.02);
  for (const std::size_t i : {12u, 13u, 14u}) EXPECT_TRUE(std::isnan(found.angles[i]));
}

TEST_F(TurntableTest, OneAngleOnlyIsNone) {
  for (int i = 0; i < 12; ++i) take(camera_at(0, 25, 500), 0, {0.01, 0.05});
  const TurntableMotion found = find_turntable(result_);
  EXPECT_FALSE(found.found);
  EXPECT_THAT(found.reason, HasSubstr("from one side"));
}

TEST_F(TurntableTest, FewPhotographsAreNone) {
  EXPECT_FALSE(find_turntable(result_).found);
  take(camera_at(0, 25, 500), 0);
  take(camera_at(0, 25, 500), 90);
  const TurntableMotion found = find_turntable(result_);
  EXPECT_FALSE(found.found);
  EXPECT_THAT(found.reason, HasSubstr("2 photographs are posed, and 5"));
}

TEST_F(TurntableTest, AWalkIsNone) {
  for (int i = 0; i < 24; ++i)
    take_walking(15 * i + 3 * normal_(random_), 30 + 4 * normal_(random_),
                 500 * (1 + 0.05 * normal_(random_)));
  const TurntableMotion found = find_turntable(result_);
  EXPECT_FALSE(found.found);
  EXPECT_THAT(found.reason, HasSubstr("one place"));
}

}  // namespace
}  // namespace photohull
