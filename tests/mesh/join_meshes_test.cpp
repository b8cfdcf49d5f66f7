#include "mesh/join_meshes.h"

#include <gtest/gtest.h>

namespace photohull {
namespace {

/// A square of `side` at height 0, its middle at `origin`, of triangles with edges about `edge`
/// long; its vertices have confidence.
TriMesh square(double side, double edge, const glm::dvec3& origin = glm::dvec3(0)) {
  TriMesh mesh;
  mesh.origin = origin;
  const auto n = std::uint32_t(std::lround(side / edge));
  for (std::uint32_t y = 0; y <= n; ++y)
    for (std::uint32_t x = 0; x <= n; ++x) {
      mesh.positions.emplace_back(edge * x - side / 2, edge * y - side / 2, 0);
      mesh.confidence.push_back(0.5f);
    }
  for (std::uint32_t y = 0; y < n; ++y)
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t a = y * (n + 1) + x, b = a + n + 1;
      mesh.triangles.push_back({a, a + 1, b + 1});
      mesh.triangles.push_back({a, b + 1, b});
    }
  return mesh;
}

double area_within(const TriMesh& mesh, double half) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const glm::dvec3 p = mesh.world(a), q = mesh.world(b), r = mesh.world(c);
    const glm::dvec3 middle = (p + q + r) / 3.0;
    if (std::max(std::abs(middle.x), std::abs(middle.y)) < half)
      sum += 0.5 * glm::length(glm::cross(q - p, r - p));
  }
  return sum;
}

TEST(JoinMeshes, AppendedMeshesKeepTheirPlaceInTheWorld) {
  TriMesh to = square(1, 1);
  const TriMesh from = square(1, 1, {5, 6, 7});
  append_mesh(from, to);
  ASSERT_EQ(to.positions.size(), 8u);
  ASSERT_EQ(to.triangles.size(), 4u);
  EXPECT_EQ(to.world(4), glm::dvec3(4.5, 5.5, 7));
  EXPECT_EQ(to.triangles[2], (decltype(to.triangles)::value_type{4, 5, 7}));
  EXPECT_EQ(to.confidence.size(), 8u);
}

TEST(JoinMeshes, AttributesOfOneAloneGo) {
  TriMesh to = square(1, 1), from = square(1, 1);
  from.confidence.clear();
  append_mesh(from, to);
  EXPECT_TRUE(to.confidence.empty());
  TriMesh empty;
  append_mesh(square(1, 1), empty);
  EXPECT_EQ(empty.confidence.size(), 4u);
  append_mesh(TriMesh(), empty);
  EXPECT_EQ(empty.positions.size(), 4u);
}

// The coarse surface ends just within the border of the fine one: no gap, and no second layer.
TEST(JoinMeshes, WhatTheFinerMeshHasGoes) {
  const double reach = 0.4;
  const TriMesh fine = square(2, 0.05, {0, 0, 0.02});
  TriMesh coarse = square(8, 0.2);
  std::vector<float> more(coarse.positions.size(), 1);
  leave_out_covered(fine, reach, coarse, {&more});
  EXPECT_EQ(area_within(coarse, 0.5), 0);                  // two layers nowhere in the middle
  EXPECT_NEAR(area_within(coarse, 4), 64 - 2.5 * 2.5, 3);  // and all beyond an overlap
  EXPECT_GT(area_within(coarse, 1.5), 9 - 2.9 * 2.9);      // which begins near the border
  EXPECT_EQ(more.size(), coarse.positions.size());
  EXPECT_EQ(coarse.confidence.size(), coarse.positions.size());
}

TEST(JoinMeshes, FarSurfaceStays) {
  TriMesh coarse = square(2, 0.2, {0, 0, 1});
  const std::size_t before = coarse.triangles.size();
  leave_out_covered(square(2, 0.05), 0.4, coarse);
  EXPECT_EQ(coarse.triangles.size(), before);
}

}  // namespace
}  // namespace photohull
