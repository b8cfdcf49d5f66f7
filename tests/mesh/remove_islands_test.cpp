#include "mesh/remove_islands.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "support/analytic_volumes.h"
#include "volume/extract_mesh.h"

namespace photohull {
namespace {

/// A large ball in the middle, and smaller ones; voxels are 1 large.
class Islands : public testing::Test {
 protected:
  Islands() { add({32, 32, 32}, 20, 6); }

  void add(const glm::dvec3& centre, double radius, float views, float confidence = 0.9f) {
    const TriMesh ball = extract_mesh(sample_volume(glm::ivec3(12), sphere(centre, radius)));
    const auto first = std::uint32_t(mesh_.positions.size());
    if (first == 0) mesh_.origin = ball.origin;
    for (std::size_t i = 0; i < ball.positions.size(); ++i) {
      mesh_.positions.emplace_back(ball.world(i) - mesh_.origin);
      mesh_.confidence.push_back(confidence);
      views_.push_back(views);
    }
    for (const auto& [a, b, c] : ball.triangles)
      mesh_.triangles.push_back({a + first, b + first, c + first});
  }
  RemovedIslands remove() { return remove_islands(mesh_, views_, {.voxel_size = 1}); }
  /// Is any of the mesh there?
  bool holds(const glm::dvec3& centre, double radius) const {
    for (std::size_t i = 0; i < mesh_.positions.size(); ++i)
      if (glm::distance(mesh_.world(i), centre) < radius + 1) return true;
    return false;
  }

  TriMesh mesh_;
  std::vector<float> views_;
};

TEST_F(Islands, TheMainPieceStays) {
  const std::size_t before = mesh_.triangles.size();
  EXPECT_EQ(remove().pieces, 0u);
  EXPECT_EQ(mesh_.triangles.size(), before);
}

TEST_F(Islands, WhatNoiseCanMakeGoes) {
  add({70, 70, 70}, 1.2, 6);  // 18 voxels squared, as well supported as the rest
  const RemovedIslands gone = remove();
  EXPECT_EQ(gone.pieces, 1u);
  EXPECT_NEAR(gone.area_share, 18.0 / (18 + 5027), 0.002);
  EXPECT_FALSE(holds({70, 70, 70}, 1.2));
  EXPECT_TRUE(holds({32, 32, 32}, 20));
  ASSERT_EQ(mesh_.confidence.size(), mesh_.positions.size());
}

TEST_F(Islands, WhatFewViewsSupportGoes) {
  add({70, 70, 70}, 2.5, 6);  // 79 voxels squared each
  add({70, 70, 20}, 2.5, 2);
  add({20, 70, 70}, 2.5, 6, 0.4f);
  EXPECT_EQ(remove().pieces, 2u);
  EXPECT_TRUE(holds({70, 70, 70}, 2.5));
  EXPECT_FALSE(holds({70, 70, 20}, 2.5));
  EXPECT_FALSE(holds({20, 70, 70}, 2.5));
}

TEST_F(Islands, LargePartsNeedLessSupport) {
  add({72, 72, 72}, 6, 3);  // a tenth of the area, two fifths of the support
  EXPECT_EQ(remove().pieces, 0u);
  add({72, 72, 20}, 6, 1);  // a single view confirms nothing
  EXPECT_EQ(remove().pieces, 1u);
}

TEST_F(Islands, DashesInARowStay) {
  for (const double z : {60.0, 65.0, 70.0, 75.0}) add({72, 72, z}, 1.3, 6);  // gaps of 2.4
  add({72, 20, 72}, 1.3, 6);
  EXPECT_EQ(remove().pieces, 1u);
  EXPECT_TRUE(holds({72, 72, 60}, 1.3));
  EXPECT_TRUE(holds({72, 72, 75}, 1.3));
  EXPECT_FALSE(holds({72, 20, 72}, 1.3));
}

TEST_F(Islands, DashesThatFewViewsSupportGo) {
  for (const double z : {60.0, 65.0, 70.0, 75.0}) add({72, 72, z}, 1.3, 2);
  EXPECT_EQ(remove().pieces, 4u);
}

TEST_F(Islands, ADashThatContinuesTheMainPieceStays) {
  add({32, 32, 55}, 1.3, 6);  // a gap of 1.7
  EXPECT_EQ(remove().pieces, 0u);
}

TEST_F(Islands, NeedsAVoxelSize) { EXPECT_THROW(remove_islands(mesh_, views_, {}), UsageError); }

TEST_F(Islands, AMeshWithoutTrianglesStays) {
  TriMesh empty;
  EXPECT_EQ(remove_islands(empty, {}, {.voxel_size = 1}).pieces, 0u);
}

}  // namespace
}  // namespace photohull
