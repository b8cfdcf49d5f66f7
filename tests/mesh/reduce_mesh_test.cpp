// Meshes made small enough to be looked at.
#include "mesh/reduce_mesh.h"

#include <gtest/gtest.h>

#include "support/analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

const glm::dvec3 kCentre(31.3, 32.1, 30.7);  // off the lattice
constexpr double kRadius = 24;               // voxels

TriMesh ball() {
  return extract_mesh(sample_volume(
      glm::ivec3(8), [](const glm::dvec3& p) { return glm::distance(p, kCentre) - kRadius; },
      glm::dvec3(0), 1));
}

TEST(ReduceMesh, LeavesNoMoreTrianglesThanAskedFor) {
  const TriMesh mesh = ball();
  for (const std::size_t most : {500u, 5000u}) {
    const TriMesh few = reduce_mesh(mesh, most);
    EXPECT_LE(few.triangles.size(), most);
    EXPECT_GT(few.triangles.size(), most * 9 / 10);
    EXPECT_LT(measure_distance(mesh, few, 1).max, most == 500 ? 1 : 0.1);
  }
}

TEST(ReduceMesh, KeepsVerticesWithAllThatIsKnownOfThem) {
  TriMesh mesh = ball();
  std::vector<float> heights, shares;
  for (const glm::vec3& p : mesh.positions) {
    heights.push_back(p.z);
    shares.push_back(p.x / 64);
    mesh.colours.push_back(p / 64.0f);
    mesh.confidence.push_back(p.y / 64);
  }
  const TriMesh few = reduce_mesh(mesh, 1000, {&heights, &shares});
  ASSERT_EQ(heights.size(), few.positions.size());
  ASSERT_EQ(shares.size(), few.positions.size());
  ASSERT_EQ(few.normals.size(), few.positions.size());
  for (std::size_t v = 0; v < heights.size(); ++v) {
    EXPECT_EQ(heights[v], few.positions[v].z);
    EXPECT_EQ(shares[v], few.positions[v].x / 64);
    EXPECT_EQ(few.colours[v], few.positions[v] / 64.0f);
    EXPECT_EQ(few.confidence[v], few.positions[v].y / 64);
  }
}

TEST(ReduceMesh, LeavesASmallMeshAsItIs) {
  const TriMesh mesh = ball();
  const TriMesh same = reduce_mesh(mesh, mesh.triangles.size());
  EXPECT_EQ(same.triangles, mesh.triangles);
  EXPECT_EQ(same.positions, mesh.positions);
  EXPECT_TRUE(reduce_mesh({}, 10).triangles.empty());
}

TEST(ReduceMesh, GivesTheSameEveryTime) {
  const TriMesh mesh = ball();
  EXPECT_EQ(reduce_mesh(mesh, 2000).triangles, reduce_mesh(mesh, 2000).triangles);
}

}  // namespace
}  // namespace photohull
