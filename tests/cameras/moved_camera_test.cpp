#include "cameras/moved_camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace photohull {
namespace {

Camera camera_at(const glm::dvec3& center, double focal) {
  Camera camera;
  camera.intrinsics = {640, 480, focal, 1.1 * focal, 0.7, 318, 241};
  const glm::dvec3 z = -glm::normalize(center), x = glm::normalize(glm::cross(z, {0, 0.1, 1})),
                   y = glm::cross(z, x);
  camera.cam_from_world.rotation = glm::transpose(glm::dmat3(x, y, z));
  camera.cam_from_world.translation = -(camera.cam_from_world.rotation * center);
  return camera;
}

using Unknowns15 = std::array<double, 15>;  // two poses, and what cameras share
using TwoResiduals = std::function<glm::dvec2(const Unknowns15&)>;

/// Central differences of two residuals by one of the unknowns.
glm::dvec2 slope(const TwoResiduals& residuals, Unknowns15 at, std::size_t by) {
  constexpr double kStep = 1e-4;
  at[by] += kStep;
  const glm::dvec2 above = residuals(at);
  at[by] -= 2 * kStep;
  return (above - residuals(at)) / (2 * kStep);
}

class MovedCameras : public testing::TestWithParam<double> {  // how large turns and moves are
 protected:
  Unknowns15 random_unknowns() {
    std::normal_distribution<double> normal(0, GetParam());
    Unknowns15 u;
    for (double& x : u) x = GetParam() > 0 ? normal(random_) : 0;
    return u;
  }
  MovedCamera first(const Unknowns15& u) const { return {a_, u.data()}; }
  MovedCamera second(const Unknowns15& u) const { return {b_, u.data() + 6}; }
  static SharedUnknowns shared(const Unknowns15& u) { return {u[12], u[13], u[14]}; }

  std::mt19937 random_{7};
  const glm::dvec3 middle_{0.1, -0.2, 0.3};
  const Motion a_{camera_at({4, 1, 0.5}, 700), middle_};
  const Motion b_{camera_at({2, 3.5, -0.4}, 650), middle_};
};

TEST_P(MovedCameras, TracksHaveTheDerivativesOfTheirDifferences) {
  const glm::dvec3 point(0.2, 0.1, -0.3);
  const glm::dvec2 pixel(330, 260);
  for (int run = 0; run < 5; ++run) {
    const Unknowns15 at = random_unknowns();
    const TwoResiduals residuals = [&](const Unknowns15& u) {
      glm::dvec2 r(0.0);
      EXPECT_TRUE(track_residual(first(u), shared(u), point, pixel, r, nullptr));
      return r;
    };
    TrackDerivatives by;
    glm::dvec2 same(0.0);
    ASSERT_TRUE(track_residual(first(at), shared(at), point, pixel, same, &by));
    EXPECT_EQ(same, residuals(at));
    for (std::size_t i = 0; i < 6; ++i)
      for (int r = 0; r < 2; ++r)
        EXPECT_NEAR(by.by_pose[std::size_t(r)][i], slope(residuals, at, i)[r], 1e-5) << i;
    for (std::size_t i = 0; i < 3; ++i)
      for (int r = 0; r < 2; ++r)
        EXPECT_NEAR(by.by_shared[std::size_t(r)][i], slope(residuals, at, 12 + i)[r], 1e-5) << i;
    const TwoResiduals moved_point = [&](const Unknowns15& u) {
      glm::dvec2 r(0.0);
      track_residual(first(at), shared(at), point + glm::dvec3(u[0], u[1], u[2]), pixel, r,
                     nullptr);
      return r;
    };
    for (std::size_t i = 0; i < 3; ++i)
      for (int r = 0; r < 2; ++r)
        EXPECT_NEAR(by.by_point[std::size_t(r)][i], slope(moved_point, {}, i)[r], 1e-3) << i;
  }
}

TEST_P(MovedCameras, TangentsHaveTheDerivativesOfTheirDifferences) {
  const FrontierPair pair{0, 1, {300, 150}, {340, 170}};
  for (int run = 0; run < 5; ++run) {
    const Unknowns15 at = random_unknowns();
    const TwoResiduals residuals = [&](const Unknowns15& u) {
      return tangent_residual(first(u), second(u), shared(u), pair, nullptr);
    };
    TangentDerivatives by;
    EXPECT_EQ(tangent_residual(first(at), second(at), shared(at), pair, &by), residuals(at));
    for (std::size_t i = 0; i < 15; ++i) {
      const glm::dvec2 expected = slope(residuals, at, i);
      for (std::size_t r = 0; r < 2; ++r) {
        const double found = i < 6    ? by.by_pose_a[r][i]
                             : i < 12 ? by.by_pose_b[r][i - 6]
                                      : by.by_shared[r][i - 12];
        EXPECT_NEAR(found, expected[int(r)], 1e-5 * (1 + std::abs(expected[int(r)]))) << i;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Motions, MovedCameras, testing::Values(0, 1e-3, 0.5, 20, 300));

TEST(MovedCamera, TangentsAreEpipolarDistances) {
  const Motion a(camera_at({4, 1, 0.5}, 700), {}), b(camera_at({2, 3.5, -0.4}, 650), {});
  const FrontierPair pair{0, 1, {300, 150}, {340, 170}};
  const std::array<double, 6> none{};
  const glm::dvec2 signed_distances = tangent_residual(
      MovedCamera(a, none.data()), MovedCamera(b, none.data()), {0, 0, 0}, pair, nullptr);
  const glm::dvec2 expected = epipolar_distances(a.camera, b.camera, pair);
  EXPECT_NEAR(std::abs(signed_distances.x), std::abs(expected.x), 1e-6);
  EXPECT_NEAR(std::abs(signed_distances.y), std::abs(expected.y), 1e-6);
}

TEST(MovedCamera, UnknownsBringACameraToAnotherPose) {
  const Camera given = camera_at({4, 1, 0.5}, 700), other = camera_at({3.9, 1.2, 0.4}, 700);
  const Motion motion(given, {0.1, 0.2, 0.3});
  const MovedCamera moved(motion, motion.unknowns_to(other.cam_from_world).data());
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(moved.pose.translation[i], other.cam_from_world.translation[i], 1e-9);
    EXPECT_NEAR(moved.center[i], other.center()[i], 1e-9);
    for (int j = 0; j < 3; ++j)
      EXPECT_NEAR(moved.pose.rotation[i][j], other.cam_from_world.rotation[i][j], 1e-9);
  }
}

TEST(MovedCamera, APointBehindTheCameraHasNoResidual) {
  const Motion motion(camera_at({4, 1, 0.5}, 700), {});
  const std::array<double, 6> none{};
  glm::dvec2 residual;
  EXPECT_FALSE(track_residual(MovedCamera(motion, none.data()), {0, 0, 0}, {8, 2, 1}, {0, 0},
                              residual, nullptr));
}

}  // namespace
}  // namespace photohull
