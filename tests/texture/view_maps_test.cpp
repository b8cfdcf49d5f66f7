#include "texture/view_maps.h"

#include <gtest/gtest.h>

#include "scenes.h"

namespace photohull::texture {
namespace {

/// A square across the z axis, seen from +z.
TriMesh square(double half, double z) {
  TriMesh mesh;
  const float h = float(half), d = float(z);
  mesh.positions = {{-h, -h, d}, {h, -h, d}, {h, h, d}, {-h, h, d}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

PreparedView view_from(const glm::dvec3& eye, int size, double focal) {
  PreparedView view;
  view.camera = test::look_at(eye, {0, 0, 0}, focal, size, size, {0, -1, 0});
  view.image = test::ray_cast(
      view.camera, [](const glm::dvec3&, const glm::dvec3&) { return glm::dvec3(0.5); }, 1);
  return view;
}

TEST(ViewMaps, ClearanceGrowsFromTheOutlineInward) {
  const PreparedView view = view_from({0, 0, 10}, 41, 100);
  // It covers the pixels up to 10 from the middle one.
  const ViewMaps maps(square(1.05, 0), ViewPixels(view, 1));
  const double depth = 0.1;
  EXPECT_EQ(maps.clearance_of(20, 20, depth), kFullClearance);
  EXPECT_EQ(maps.clearance_of(30, 20, depth), 1);
  EXPECT_EQ(maps.clearance_of(29, 20, depth), 2);
  EXPECT_EQ(maps.clearance_of(28, 29, depth), 2);
  EXPECT_EQ(maps.clearance_of(31, 20, depth), 0);
  EXPECT_EQ(maps.clearance_of(-1, 20, depth), 0);
}

TEST(ViewMaps, WhatStandsBeforeHidesAndKeepsADistance) {
  const PreparedView view = view_from({0, 0, 10}, 81, 100);
  const ViewMaps maps(joined(square(3, 0), square(0.5, 2)), ViewPixels(view, 1));
  EXPECT_EQ(maps.clearance_of(40, 40, 1.0 / 10), 0);  // behind the small one
  EXPECT_EQ(maps.clearance_of(40, 40, 1.0 / 8), kFullClearance);
  // The small one ends 6.25 pixels from the middle.
  EXPECT_EQ(maps.clearance_of(47, 40, 1.0 / 10), 1);
  EXPECT_EQ(maps.clearance_of(48, 40, 1.0 / 10), 2);
  EXPECT_EQ(maps.clearance_of(46, 40, 1.0 / 8), 1);
  EXPECT_EQ(maps.clearance_of(55, 40, 1.0 / 10), kFullClearance);
}

TEST(ViewMaps, SlopesAreNoEdges) {
  const PreparedView view = view_from({8, 0, 5}, 41, 100);
  const ViewMaps maps(square(3, 0), ViewPixels(view, 1));
  EXPECT_EQ(maps.clearance(20, 20), kFullClearance);
}

TEST(ViewMaps, MasksKeepADistance) {
  PreparedView view = view_from({0, 0, 10}, 41, 100);
  view.silhouette.distance = {41, 41, std::vector<float>(41 * 41)};
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 41; ++x)
      view.silhouette.distance.pixels[std::size_t(41 * y + x)] = x - 20.5f;
  const ViewMaps maps(square(3, 0), ViewPixels(view, 1));
  EXPECT_EQ(maps.clearance_of(21, 20, 0.1), 0);
  EXPECT_EQ(maps.clearance_of(20, 20, 0.1), 1);
  EXPECT_EQ(maps.clearance_of(18, 20, 0.1), 3);
  EXPECT_EQ(maps.clearance_of(10, 20, 0.1), kFullClearance);
}

TEST(ViewMaps, WhatReachesBehindTheCameraIsCutOff) {
  const PreparedView view = view_from({0, 0, 10}, 41, 30);
  TriMesh wall;  // beside the camera, from before it to behind it
  wall.positions = {{-0.5f, -5, 0}, {-0.5f, 5, 0}, {-0.5f, 0, 20}};
  wall.triangles = {{0, 1, 2}};
  const ViewMaps maps(joined(square(9, 0), wall), ViewPixels(view, 1));
  EXPECT_EQ(maps.clearance_of(0, 20, 0.1), 0);
  EXPECT_GT(maps.clearance_of(40, 20, 0.1), 0);
}

TEST(ViewPixels, ReducedPhotographsAreMeansOfAreas) {
  PreparedView view = view_from({0, 0, 10}, 40, 100);
  for (int i = 0; i < 40 * 40; ++i)
    for (int c = 0; c < 3; ++c) view.image.bytes[std::size_t(4 * i + c)] = i % 2 ? 255 : 0;
  const ViewPixels half(view, 0.5);
  EXPECT_EQ(half.width(), 20);
  EXPECT_NEAR(half.root(7, 9).x, std::sqrt(0.5), 1e-3);
  const auto whole = view.camera.project({0.3, -0.2, 1}),
             reduced = half.camera().project({0.3, -0.2, 1});
  EXPECT_NEAR((whole->x + 0.5) / 2, reduced->x + 0.5, 1e-9);
  EXPECT_NEAR((whole->y + 0.5) / 2, reduced->y + 0.5, 1e-9);
}

}  // namespace
}  // namespace photohull::texture
