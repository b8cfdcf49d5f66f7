#include "render/surface_points.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render/meshes.h"

namespace photohull::render {
namespace {

const GridSpec kGrid{{-3, 4, 10}, 0.1, {4, 4, 4}};

TEST(SurfacePoints, VerticesInVoxelCoordinates) {
  TriMesh mesh = test::sphere_mesh(kGrid.world({10, 11, 12}), 0.5, 4);
  const auto vertices = to_voxels(kGrid, mesh);
  EXPECT_NEAR(vertices[0].position.z, 17, 1e-4);  // the pole
  EXPECT_NEAR(vertices[0].position.x, 10, 1e-4);
}

TEST(SurfacePoints, FineMeshesNeedNoMore) {
  TriMesh mesh;
  mesh.origin = kGrid.origin;
  test::add_plate(1, 1, 1, 0.5, 0.1, mesh);
  EXPECT_TRUE(points_between(mesh, to_voxels(kGrid, mesh)).empty());
}

TEST(SurfacePoints, LargeTrianglesAreFilled) {
  TriMesh mesh;
  mesh.origin = kGrid.origin;
  test::add_plate(1, 1, 1, 1, 2, mesh);
  const auto points = points_between(mesh, to_voxels(kGrid, mesh));
  for (int y = 1; y < 20; ++y)
    for (int x = 1; x < 20; ++x) {
      const bool near = std::any_of(points.begin(), points.end(), [&](const auto& p) {
        return glm::distance(glm::vec3(p.position), glm::vec3(x, y, 10)) < 1.0f;
      });
      EXPECT_TRUE(near) << x << ", " << y;
    }
  for (const auto& p : points) EXPECT_LT(p.normal.z, 0) << "normals are the triangles' own";
}

}  // namespace
}  // namespace photohull::render
