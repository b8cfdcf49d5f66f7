#include "render/turntable.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/meshes.h"
#include "render/scene_up.h"
#include "support/cameras.h"

namespace photohull::render {
namespace {

const glm::dvec3 kCentre{500, -60, 7};
const glm::dvec3 kUp = glm::normalize(glm::dvec3(0.2, -1, 0.1));

/// A ball twice as long along z.
TriMesh long_ball() {
  TriMesh mesh = test::sphere_mesh(kCentre, 1, 30);
  for (glm::vec3& p : mesh.positions) p.z *= 2;
  return mesh;
}

TEST(Turntable, KeepsTheWholeModelInEveryPictureAndFillsIt) {
  const TriMesh mesh = long_ball();
  for (const auto& [width, height] : {std::pair{320, 240}, {200, 300}}) {
    const auto shots = turntable(mesh, kUp, kCentre + glm::dvec3(3, 0, 0), {24, 20}, width, height);
    ASSERT_EQ(shots.size(), 24u);
    double nearest_border = 1e9;
    for (const Shot& shot : shots)
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const auto pixel = shot.camera.project(mesh.world(v));
        ASSERT_TRUE(pixel.has_value());
        const double depth = shot.camera.to_camera(mesh.world(v)).z;
        ASSERT_GT(depth, shot.window.near);
        ASSERT_LT(depth, shot.window.far);
        nearest_border = std::min(
            {nearest_border, pixel->x, pixel->y, width - 1 - pixel->x, height - 1 - pixel->y});
      }
    EXPECT_GT(nearest_border, 0.02 * std::min(width, height));
    EXPECT_LT(nearest_border, 0.1 * std::min(width, height));
  }
}

TEST(Turntable, TurnsOnceAboutUpFromTheSideThatIsGiven) {
  const TriMesh mesh = test::sphere_mesh(kCentre, 1, 20);
  const glm::dvec3 side = glm::normalize(glm::cross(kUp, glm::dvec3(0, 0, 1)));
  const auto shots = turntable(mesh, kUp, kCentre + 9.0 * side + 2.0 * kUp, {8, 30}, 64, 48);
  const glm::dvec3 first = shots[0].camera.center() - kCentre;
  EXPECT_NEAR(glm::dot(glm::normalize(first), side), std::cos(M_PI / 6), 1e-3);
  for (std::size_t i = 0; i < 8; ++i) {
    const Camera& camera = shots[i].camera;
    const glm::dvec3 centre = camera.center() - kCentre;
    EXPECT_NEAR(glm::dot(centre, kUp), 0.5 * glm::length(first), 0.01);
    EXPECT_NEAR(glm::length(centre), glm::length(first), 0.01);
    EXPECT_NEAR(glm::dot(camera.forward(), -glm::normalize(centre)), 1, 1e-4);
    // Up is up in the picture, and across it the picture is level.
    const glm::dvec3 down = glm::transpose(camera.cam_from_world.rotation)[1];
    EXPECT_LT(glm::dot(down, kUp), -0.8);
    EXPECT_NEAR(glm::dot(glm::transpose(camera.cam_from_world.rotation)[0], kUp), 0, 1e-9);
    const glm::dvec3 next = shots[(i + 1) % 8].camera.center() - kCentre;
    const auto flat = [&](const glm::dvec3& d) {
      return glm::normalize(d - glm::dot(d, kUp) * kUp);
    };
    EXPECT_NEAR(glm::dot(flat(centre), flat(next)), std::cos(M_PI / 4), 1e-3);
  }
}

TEST(SeenFrom, ShowsAllOfThePhotographAndMoreBesideIt) {
  const TriMesh mesh = test::sphere_mesh(kCentre, 1, 20);
  const Camera camera = test::look_at(kCentre + glm::dvec3(6, 0, 0), kCentre, 200, 160, 120);
  const Shot same = seen_from(mesh, camera, 160, 120);
  EXPECT_DOUBLE_EQ(same.window.x, -0.5);
  EXPECT_DOUBLE_EQ(same.window.y, -0.5);
  EXPECT_DOUBLE_EQ(same.window.width, 160);
  EXPECT_DOUBLE_EQ(same.window.height, 120);
  const Shot wide = seen_from(mesh, camera, 640, 240);
  EXPECT_DOUBLE_EQ(wide.window.height, 120);
  EXPECT_DOUBLE_EQ(wide.window.width, 320);
  EXPECT_DOUBLE_EQ(wide.window.x, -80.5);
}

std::vector<Camera> ring(const glm::dvec3& down, double height) {
  std::vector<Camera> cameras;
  for (int i = 0; i < 9; ++i) {
    const double a = 2 * M_PI * i / 9;
    cameras.push_back(
        test::look_at({5 * std::cos(a), 5 * std::sin(a), height}, {0, 0, 0}, 100, 64, 64, down));
  }
  return cameras;
}

/// The camera turned about its axis by a right angle.
Camera on_its_side(Camera camera) {
  glm::dmat3& r = camera.cam_from_world.rotation;
  r = glm::dmat3(glm::dvec3(0, -1, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1)) * r;
  return camera;
}

void expect_up(const std::vector<Camera>& cameras, const glm::dvec3& up) {
  const glm::dvec3 found = scene_up(cameras, {0, 0, 0});
  EXPECT_GT(glm::dot(found, up), 0.999) << found.x << ' ' << found.y << ' ' << found.z;
}

TEST(SceneUp, IsWhatPhotographsHaveAbove) {
  expect_up(ring({0, 0, -1}, 2), {0, 0, 1});
  expect_up(ring({0, 0, 1}, 2), {0, 0, -1});
  expect_up({}, {0, 0, 1});
}

TEST(SceneUp, IsTheAxisThatCamerasOnTheirSidesCircle) {
  std::vector<Camera> cameras = ring({0, 0, -1}, 2);
  for (Camera& camera : cameras) camera = on_its_side(camera);
  expect_up(cameras, {0, 0, 1});
}

TEST(SceneUp, IsTheCamerasSideWhereHalfOfThemStandOnTheirHeads) {
  std::vector<Camera> cameras = ring({0, 0, -1}, -2);
  const std::vector<Camera> turned = ring({0, 0, 1}, -2);
  cameras.insert(cameras.end(), turned.begin(), turned.end());
  expect_up(cameras, {0, 0, -1});
}

}  // namespace
}  // namespace photohull::render
