#include "eval/surface_samples.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "shapes.h"

namespace photohull::eval {
namespace {

using test::plate;

TEST(SampleSurface, UniformOverTheAreaWhateverTheTriangles) {
  // A coarse plate beside a fine one of a quarter of its area, and a face without area between.
  TriMesh mesh = plate(0, 0, 0, 2, 1);
  mesh.triangles.push_back({0, 1, 1});
  mesh = test::together(mesh, plate(5, 0, 0, 1, 10));
  const SurfaceSamples samples = sample_surface(mesh, 50000, 1);
  EXPECT_NEAR(samples.area, 5, 1e-6);
  ASSERT_EQ(samples.points.size(), 50000u);
  std::map<std::pair<int, int>, int> cells;  // of edge 0.5
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const glm::dvec3& p = samples.points[i];
    ++cells[{int(2 * p.x), int(2 * p.y)}];
    ASSERT_NE(samples.triangles[i], 2u);
    ASSERT_EQ(p.z, 0);
  }
  ASSERT_EQ(cells.size(), 20u);
  for (const auto& [cell, count] : cells) EXPECT_NEAR(count, 2500, 150) << cell.first;
}

TEST(SampleSurface, SeedsDecide) {
  const TriMesh mesh = plate(0, 0, 0, 1, 3);
  EXPECT_EQ(sample_surface(mesh, 1000, 5).points, sample_surface(mesh, 1000, 5).points);
  EXPECT_NE(sample_surface(mesh, 1000, 5).points, sample_surface(mesh, 1000, 6).points);
}

TEST(ThinPoints, OneCentroidACell) {
  TriMesh cloud;
  cloud.origin = {100, 0, 0};
  cloud.positions = {{0, 0, 0}, {0.5, 0, 0}, {0.9, 0.3, 0}, {1.1, 0, 0}, {7, 7, 7}};
  const SurfaceSamples samples = thin_points(cloud, 1);
  ASSERT_EQ(samples.points.size(), 3u);
  EXPECT_NEAR(glm::distance(samples.points[0], {100 + 1.4 / 3, 0.1, 0}), 0, 1e-7);
  EXPECT_NEAR(glm::distance(samples.points[1], {101.1, 0, 0}), 0, 1e-6);
  EXPECT_EQ(samples.points[2], glm::dvec3(107, 7, 7));
  EXPECT_TRUE(samples.triangles.empty());
}

}  // namespace
}  // namespace photohull::eval
