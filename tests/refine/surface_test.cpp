#include "refine/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "support/analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull::refine {
namespace {

std::vector<std::uint32_t> neighbours(const VertexGraph& graph, std::size_t vertex) {
  const auto span = graph.of(vertex);
  return {span.begin(), span.end()};
}

TEST(MakeGraph, TetrahedronJoinsAllToAll) {
  TriMesh mesh;
  mesh.positions.resize(5);  // the last vertex belongs to no triangle
  mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  const VertexGraph graph = make_graph(mesh);
  ASSERT_EQ(graph.vertices(), 5u);
  EXPECT_EQ(neighbours(graph, 0), (std::vector<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(neighbours(graph, 2), (std::vector<std::uint32_t>{0, 1, 3}));
  EXPECT_TRUE(graph.of(4).empty());
}

TEST(MakeGraph, OpenMeshHasItsBorderEdgesToo) {
  TriMesh mesh;
  mesh.positions.resize(4);
  mesh.triangles = {{0, 1, 2}, {2, 1, 3}};
  const VertexGraph graph = make_graph(mesh);
  EXPECT_EQ(neighbours(graph, 0), (std::vector<std::uint32_t>{1, 2}));
  EXPECT_EQ(neighbours(graph, 1), (std::vector<std::uint32_t>{0, 2, 3}));
}

TEST(MakeGraph, EdgesOfASurfaceEachOnceInBothDirections) {
  const TriMesh mesh = extract_mesh(sample_volume({3, 3, 3}, torus(glm::dvec3(11.5), 7, 2.5)));
  const VertexGraph graph = make_graph(mesh);
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      edges.emplace(t[i], t[(i + 1) % 3]);
      edges.emplace(t[(i + 1) % 3], t[i]);
    }
  ASSERT_EQ(graph.vertices(), mesh.positions.size());
  EXPECT_EQ(graph.neighbours.size(), edges.size());
  for (std::uint32_t i = 0; i < graph.vertices(); ++i) {
    EXPECT_TRUE(std::is_sorted(graph.of(i).begin(), graph.of(i).end()));
    for (const std::uint32_t j : graph.of(i)) EXPECT_TRUE(edges.contains({i, j}));
  }
}

TEST(MakeGraph, EmptyMesh) {
  EXPECT_EQ(make_graph({}).vertices(), 0u);
  EXPECT_EQ(VertexGraph{}.vertices(), 0u);
}

TEST(NearDistances, AreThoseOfTheVolumeNearItsSurface) {
  const SparseVolume volume = sample_volume({3, 3, 3}, torus(glm::dvec3(11.5), 7, 2.5));
  const NearDistances near(volume);
  std::size_t known = 0;
  for (std::size_t brick = 0; brick < volume.table.size(); ++brick)
    for (int v = 0; v < kBrickVoxels; ++v) {
      const std::uint32_t slot = volume.table[brick];
      const std::optional<float> found = near.at(brick, v);
      if (slot >= SparseVolume::kInside) {
        EXPECT_FALSE(found);
        continue;
      }
      const float distance = volume.distance[slot * std::size_t(kBrickVoxels) + std::size_t(v)];
      if (std::abs(distance) < kStillReach) {
        ASSERT_TRUE(found);
      }
      if (found) {
        EXPECT_EQ(*found, distance);
      }
      known += bool(found);
    }
  EXPECT_LT(known, volume.distance.size());
}

TEST(KeepStill, TakesWhatDidNotMove) {
  const SparseVolume before = sample_volume({3, 3, 3}, torus(glm::dvec3(11.5), 7, 2.5));
  SparseVolume moved = before, again = before;
  for (std::size_t i = 0; i < moved.distance.size(); ++i) {
    if (i % 2) moved.distance[i] += 0.25f;  // the others stay
    again.distance[i] = -9;
  }
  keep_still(NearDistances(before), moved, again);
  for (std::size_t i = 0; i < moved.distance.size(); ++i) {
    const bool still = i % 2 == 0 && std::abs(moved.distance[i]) < kStillReach;
    EXPECT_EQ(again.distance[i], still ? moved.distance[i] : -9);
  }
}

}  // namespace
}  // namespace photohull::refine
