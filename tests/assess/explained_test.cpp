#include "assess/explained.h"

#include <gtest/gtest.h>

#include "meshes.h"
#include "support/ray_cast.h"

namespace photohull::assess {
namespace {

const Box kAround{glm::dvec3(-1.3), glm::dvec3(1.3)};

/// A textured sphere of radius 1 before an even background, from cameras around its equator.
std::vector<PreparedView> photographs(double step_degrees, int count, double texture = 0.15) {
  std::vector<PreparedView> views;
  for (int i = 0; i < count; ++i) {
    const double a = step_degrees * i * 3.14159265358979 / 180;
    PreparedView view;
    view.camera = test::look_at({6 * std::cos(a), 6 * std::sin(a), 0}, {0, 0, 0}, 300, 160, 160);
    view.image = test::ray_cast(view.camera, [&](const glm::dvec3& eye, const glm::dvec3& ray) {
      const double b = glm::dot(eye, ray), c = glm::dot(eye, eye) - 1;
      if (b * b < c) return glm::dvec3(0.1);
      return texture > 0 ? test::noise_colour(eye + (-b - std::sqrt(b * b - c)) * ray, texture)
                         : glm::dvec3(0.4);
    });
    views.push_back(std::move(view));
  }
  return views;
}

/// The sphere's triangles whose middle is `kept`.
TriMesh part_of_sphere(double radius, auto&& kept) {
  TriMesh mesh = test::sphere_mesh({0, 0, 0}, radius, 90);
  std::erase_if(mesh.triangles, [&](const auto& t) {
    return !kept((mesh.world(t[0]) + mesh.world(t[1]) + mesh.world(t[2])) / 3.0);
  });
  return mesh;
}

TriMesh whole(double radius) {
  return part_of_sphere(radius, [](const glm::dvec3&) { return true; });
}

Explained explain(const TriMesh& mesh, const std::vector<PreparedView>& views,
                  const Box& box = kAround) {
  return explain_photographs(mesh, RayScene(mesh), box, views,
                             {.voxel_size = 0.03, .pixel_size = 0.02, .noise = 0});
}

TEST(Explained, TheRightSurfaceExplainsTheTexture) {
  const Explained e = explain(whole(1), photographs(12, 30));
  EXPECT_GT(e.told(), 2000);
  EXPECT_GT(e.explained(), 0.9);
  // The box's projection is larger than the sphere's, and plain around it.
  EXPECT_GT(e.count(Place::kPlain), e.looked_at() / 4);
  int told = 0;
  for (const ExplainedView& view : e.views) {
    told += view.told();
    EXPECT_GT(view.explained(), 0.85);
  }
  EXPECT_EQ(told, e.told());
}

TEST(Explained, AHoleShowsTheInside) {
  const std::vector<PreparedView> views = photographs(12, 30);
  EXPECT_EQ(explain(whole(1), views).share_behind(), 0);
  // From the angle a to its middle, lunes of (1 + cos a) / 2 of the disc show the outside, and of
  // -cos a the inside where that is positive: 1 / pi beside 1 / 2 in the mean.
  const TriMesh half = part_of_sphere(1, [](const glm::dvec3& p) { return p.x > 0; });
  EXPECT_NEAR(explain(half, views).share_behind(), 0.39, 0.02);
}

TEST(Explained, TheSurfaceAloneLeavesOutWhatLiesBesideIt) {
  const TriMesh upper = part_of_sphere(1, [](const glm::dvec3& p) { return p.z > 0; });
  const Explained e = explain_photographs(
      upper, RayScene(upper), kAround, photographs(12, 30),
      {.voxel_size = 0.03, .pixel_size = 0.02, .noise = 0, .surface_alone = true});
  EXPECT_GT(e.told(), 500);
  EXPECT_GT(e.explained(), 0.9);
  EXPECT_EQ(e.count(Place::kMissed) + e.count(Place::kBare) + e.count(Place::kCut), 0);
}

TEST(Explained, ASurfaceThatIsOffDisagrees) {
  const std::vector<PreparedView> views = photographs(12, 30, 0.06);
  EXPECT_GT(explain(whole(1), views).explained(), 0.9);
  // A pixel is 0.02 large; 12 degrees aside the surface moves by a fifth of what it is off.
  const Explained inside = explain(whole(0.8), views), outside = explain(whole(1.2), views);
  EXPECT_LT(inside.explained(), 0.5);
  EXPECT_LT(outside.explained(), 0.5);
  EXPECT_GT(inside.share_told(Place::kDisagreeing), 0.3);
  EXPECT_GT(outside.share_told(Place::kDisagreeing), 0.5);
}

TEST(Explained, SurfaceThatIsLackingIsFoundInThePhotographs) {
  const TriMesh upper = part_of_sphere(1, [](const glm::dvec3& p) { return p.z > 0; });
  const Explained e = explain(upper, photographs(12, 30));
  EXPECT_NEAR(e.share_told(Place::kMissed), 0.5, 0.1);
  EXPECT_NEAR(e.explained(), 0.5, 0.1);
  EXPECT_LT(e.share_textured(Place::kBeyond) + e.share_textured(Place::kCut), 0.05);
}

TEST(Explained, WhatTheBoxCutsOffIsToldFromWhatLiesFarAway) {
  const TriMesh upper = part_of_sphere(1, [](const glm::dvec3& p) { return p.z > 0.6; });
  const Box above{{-1.3, -1.3, 0.6}, {1.3, 1.3, 1.3}};
  // Cameras that look down through the box at the sphere below it.
  std::vector<PreparedView> views = photographs(12, 30);
  for (int i = 0; i < 30; ++i) {
    const double a = 0.2094 * i;
    views[i].camera =
        test::look_at({4 * std::cos(a), 4 * std::sin(a), 4.5}, {0, 0, 0}, 300, 160, 160);
    views[i].image =
        test::ray_cast(views[i].camera, [&](const glm::dvec3& eye, const glm::dvec3& ray) {
          const double b = glm::dot(eye, ray), c = glm::dot(eye, eye) - 1;
          if (b * b < c) return glm::dvec3(0.1);
          return test::noise_colour(eye + (-b - std::sqrt(b * b - c)) * ray, 0.15);
        });
  }
  const Explained e = explain(upper, views, above);
  EXPECT_GT(e.explained(), 0.9);
  EXPECT_GT(e.share_textured(Place::kCut), 0.2);
  EXPECT_LT(e.share_textured(Place::kBeyond), 0.1);
}

TEST(Explained, ViewsTooFarApartLeaveSurfaceAlone) {
  const Explained e = explain(whole(1), photographs(90, 4));
  EXPECT_GT(e.share_told(Place::kAlone), 0.95);
  EXPECT_EQ(e.count(Place::kExplained), 0);
}

TEST(Explained, PlainPhotographsTellNothing) {
  const Explained e = explain(whole(1), photographs(12, 30, 0));
  EXPECT_GT(e.looked_at(), 5000);
  EXPECT_GT(e.count(Place::kPlain), 0.9 * e.looked_at());  // but for the outline
}

TEST(Explained, PhotographsOfSomethingElseAreNotExplained) {
  std::vector<PreparedView> views = photographs(12, 30);
  test::Rng rng(1);
  for (PreparedView& view : views) view.image = test::random_image(rng, 160, 160);
  const Explained e = explain(whole(1), views);
  EXPECT_LT(e.explained(), 0.1);  // by chance, in the best of three views
}

}  // namespace
}  // namespace photohull::assess
