#include <gtest/gtest.h>

#include "render/bake_colour.h"

namespace photohull::render {
namespace {

/// A strip of triangles along vertices 0, 1, 2, ...
TriMesh strip(std::uint32_t vertices) {
  TriMesh mesh;
  mesh.positions.resize(vertices);
  mesh.colours.resize(vertices);
  mesh.confidence.resize(vertices);
  for (std::uint32_t i = 0; i + 2 < vertices; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

TEST(FillUnseen, TakesTheNearestSeenColour) {
  TriMesh mesh = strip(20);
  mesh.confidence.front() = mesh.confidence.back() = 0.5f;
  mesh.colours.front() = {1, 0, 0};
  mesh.colours.back() = {0, 0, 1};
  fill_unseen(mesh);
  EXPECT_EQ(mesh.colours[5], glm::vec3(1, 0, 0));
  EXPECT_EQ(mesh.colours[15], glm::vec3(0, 0, 1));
  EXPECT_EQ(mesh.confidence[5], 0);
}

TEST(FillUnseen, UnreachedVerticesTakeTheMean) {
  TriMesh mesh = strip(3);
  mesh.positions.resize(5);
  mesh.colours.resize(5);
  mesh.confidence.resize(5);
  mesh.confidence[0] = mesh.confidence[1] = 1;
  mesh.colours[0] = glm::vec3(0.2f);
  mesh.colours[1] = glm::vec3(0.4f);
  fill_unseen(mesh);
  EXPECT_NEAR(mesh.colours[2].x, 0.3f, 1e-6f);
  EXPECT_NEAR(mesh.colours[4].x, 0.3f, 1e-6f);
}

TEST(FillUnseen, NobodySeesAnything) {
  TriMesh mesh = strip(4);
  fill_unseen(mesh);
  EXPECT_EQ(mesh.colours[0], glm::vec3(0.5f));
}

}  // namespace
}  // namespace photohull::render
