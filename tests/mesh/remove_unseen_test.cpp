#include "mesh/remove_unseen.h"

#include <gtest/gtest.h>

#include "mesh/simplify_mesh.h"
#include "support/analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

const glm::dvec3 kCenter(31.3, 32.1, 30.7);

/// A sphere that `seen` tells the seen points of, relative to its centre.
template <typename Seen>
TriMesh sphere_with(const Seen& seen) {
  TriMesh mesh = extract_mesh(sample_volume(glm::ivec3(8), sphere(kCenter, 20)));
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    mesh.confidence.push_back(seen(mesh.world(i) - kCenter) ? 0.5f : 0.0f);
  return mesh;
}

TEST(RemoveUnseen, HalfASphere) {
  const TriMesh mesh = sphere_with([](const glm::dvec3& p) { return p.z > 0; });
  const TriMesh open = remove_unseen(mesh);
  EXPECT_NEAR(double(open.triangles.size()) / double(mesh.triangles.size()), 0.5, 0.05);
  ASSERT_EQ(open.confidence.size(), open.positions.size());
  for (std::size_t i = 0; i < open.positions.size(); ++i)
    EXPECT_GT(open.world(i).z - kCenter.z, -2);
  // Simplified afterwards, it stays near, border included.
  const TriMesh simple = simplify_mesh(open, 0.25);
  EXPECT_LT(simple.triangles.size(), open.triangles.size() / 3);
  EXPECT_LE(measure_distance(open, simple, 0.5).max, 0.25);
}

TEST(RemoveUnseen, WhatIsMoreDoubtfulThanTheLeastGoesToo) {
  const TriMesh mesh = sphere_with([](const glm::dvec3& p) { return p.z > -10; });  // 0.5 there
  TriMesh doubtful = mesh;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (mesh.world(i).z - kCenter.z > 10) doubtful.confidence[i] = 0.4f;
  EXPECT_NEAR(double(remove_unseen(mesh, 0.45).triangles.size()),
              double(remove_unseen(mesh).triangles.size()), 0.03 * double(mesh.triangles.size()));
  const TriMesh open = remove_unseen(doubtful, 0.45);
  for (std::size_t i = 0; i < open.positions.size(); ++i)
    EXPECT_LT(std::abs(open.world(i).z - kCenter.z), 12);
  EXPECT_NEAR(double(open.triangles.size()) / double(mesh.triangles.size()), 0.5, 0.05);
}

TEST(RemoveUnseen, GapsStayClosed) {
  const TriMesh mesh = sphere_with(
      [](const glm::dvec3& p) { return glm::length(p - 20.0 * glm::dvec3(0, 0, 1)) > 1.5; });
  EXPECT_GT(std::count(mesh.confidence.begin(), mesh.confidence.end(), 0.0f), 2);
  EXPECT_EQ(remove_unseen(mesh).triangles, mesh.triangles);
}

TEST(RemoveUnseen, IslandsGo) {
  const TriMesh mesh = sphere_with(
      [](const glm::dvec3& p) { return p.z > 0 || glm::length(p - glm::dvec3(0, 0, -20)) < 1.2; });
  const TriMesh open = remove_unseen(mesh);
  for (std::size_t i = 0; i < open.positions.size(); ++i)
    EXPECT_GT(open.world(i).z - kCenter.z, -2);
}

TEST(RemoveUnseen, AllOrNothing) {
  const TriMesh seen = sphere_with([](const glm::dvec3&) { return true; });
  EXPECT_EQ(remove_unseen(seen).triangles, seen.triangles);
  EXPECT_TRUE(
      remove_unseen(sphere_with([](const glm::dvec3&) { return false; })).triangles.empty());
  EXPECT_TRUE(remove_unseen(TriMesh()).triangles.empty());
  TriMesh plain = seen;
  plain.confidence.clear();
  EXPECT_EQ(remove_unseen(plain).triangles, plain.triangles);
}

}  // namespace
}  // namespace photohull
