#include "render/choose_views.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/meshes.h"
#include "support/cameras.h"

namespace photohull::render {
namespace {

const glm::dvec3 kCentre{5, 6, 7};

std::vector<PreparedView> views_of(const std::vector<Camera>& cameras) {
  std::vector<PreparedView> views(cameras.size());
  for (std::size_t i = 0; i < cameras.size(); ++i) views[i].camera = cameras[i];
  return views;
}

TEST(ChooseViews, MainViewShowsTheMeshLargeAndWhole) {
  const TriMesh mesh = test::sphere_mesh(kCentre, 1, 30);
  std::vector<Camera> cameras = test::cameras_around(kCentre, 8, 5, 200, 160, 120);
  cameras.push_back(test::look_at(kCentre + glm::dvec3(4.2, 0, 0), kCentre, 200, 160, 120));
  // Closer, but most of the mesh falls off its image.
  cameras.push_back(
      test::look_at(kCentre + glm::dvec3(0, 3, 0), kCentre + glm::dvec3(1, 0, 0), 400, 160, 120));
  EXPECT_EQ(choose_main_view(mesh, views_of(cameras)), 5);
}

TEST(ChooseViews, OthersAreFarApart) {
  const TriMesh mesh = test::sphere_mesh(kCentre, 1, 30);
  std::vector<Camera> cameras;
  for (const double degrees : {0.0, 3.0, 90.0, 176.0, 180.0}) {
    const double a = degrees * 3.14159265358979323846 / 180;
    cameras.push_back(test::look_at(kCentre + 6.0 * glm::dvec3(std::cos(a), std::sin(a), 0),
                                    kCentre, 200, 160, 120));
  }
  const std::vector<PreparedView> views = views_of(cameras);
  EXPECT_EQ(choose_other_views(mesh, views, 0, 2), (std::vector<int>{4, 2}));
  // The other two are too close to these.
  EXPECT_EQ(choose_other_views(mesh, views, 0, 4).size(), 2u);
}

TEST(ChooseViews, FrameHoldsTheWholeMesh) {
  const TriMesh mesh = test::sphere_mesh(kCentre, 1, 30);
  const Camera camera = test::look_at(kCentre - glm::dvec3(6, 0, 0), kCentre, 200, 160, 120);
  const Window window = frame_mesh(mesh, camera, 0);
  const double radius = 200 * 1 / std::sqrt(36.0 - 1);  // of the projected circle
  EXPECT_NEAR(window.width, 2 * radius, 3);
  EXPECT_NEAR(window.height, 2 * radius, 3);
  EXPECT_NEAR(window.x + 0.5 * window.width, camera.project(kCentre)->x, 0.5);
  EXPECT_NEAR(window.near, 5, 0.05);
  EXPECT_NEAR(window.far, 7, 0.05);
}

TEST(ChooseViews, FrameOfACameraInsideTheMeshIsItsImage) {
  const TriMesh mesh = test::sphere_mesh(kCentre, 1, 30);
  const Camera camera = test::look_at(kCentre, kCentre + glm::dvec3(1, 0, 0), 200, 160, 120);
  const Window window = frame_mesh(mesh, camera, 0);
  EXPECT_EQ(window.width, 160);
  EXPECT_GT(window.near, 0);
}

}  // namespace
}  // namespace photohull::render
