#include "render/confidence.h"

#include <gtest/gtest.h>

#include <cmath>

namespace photohull::render {
namespace {

constexpr auto kPhotographs = Shaping::kPhotographs;

/// A chain of `count` triangles: vertex i is joined to i + 1 and i + 2.
TriMesh strip(std::uint32_t count) {
  TriMesh mesh;
  mesh.positions.resize(count + 2);
  for (std::uint32_t i = 0; i < count; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  return mesh;
}

TEST(PoolEvidence, EqualEvidenceStaysAsItIs) {
  const TriMesh mesh = strip(50);
  const SurfaceEvidence each{4, 1.5f, 0.03f, 0.002f, 0.01f};
  const auto pooled = pool_evidence(mesh, std::vector(mesh.positions.size(), each));
  for (const PooledEvidence& p : pooled) {
    EXPECT_TRUE(p.seen);
    EXPECT_NEAR(p.scatter, 1.5, 1e-5);
    // Four views: three degrees of freedom; the prior weighs 0.1 and has deviation 0.1.
    EXPECT_NEAR(p.disagreement, std::sqrt((4 * 0.03 + 0.1 * 0.01) / 3.1), 1e-5);
    const double fine = (4 * 0.002 + 0.1 * 0.01) / 3.1;
    EXPECT_NEAR(p.fine_share, (fine + 1e-3) / (0.01 + 2e-3), 1e-5);
  }
}

TEST(PoolEvidence, ReachesAFewNeighboursAndNoFarther) {
  const TriMesh mesh = strip(60);
  std::vector<SurfaceEvidence> evidence(mesh.positions.size(), {3, 1, 0, 0, 0});
  const float calm = pool_evidence(mesh, evidence)[30].disagreement;
  evidence[30].disagreement = 0.1f;
  const auto pooled = pool_evidence(mesh, evidence);
  EXPECT_GT(pooled[30].disagreement, 2 * calm);
  EXPECT_LT(pooled[34].disagreement, pooled[30].disagreement);
  EXPECT_GT(pooled[34].disagreement, calm);
  EXPECT_EQ(pooled[30 + 11].disagreement, calm);
  EXPECT_EQ(pooled[30 - 11].disagreement, calm);
}

TEST(PoolEvidence, TheUnseenSayNothingAndLearnNothing) {
  const TriMesh mesh = strip(20);
  std::vector<SurfaceEvidence> evidence(mesh.positions.size(), {3, 1, 0.02f, 0, 0.1f});
  const PooledEvidence before = pool_evidence(mesh, evidence)[12];
  evidence[11] = {0, 99, 99, 99, 99};
  const auto pooled = pool_evidence(mesh, evidence);
  EXPECT_FALSE(pooled[11].seen);
  EXPECT_EQ(confidence_of(pooled[11], kPhotographs), 0);
  EXPECT_NEAR(pooled[12].disagreement, before.disagreement, 1e-6);
  EXPECT_NEAR(pooled[12].scatter, before.scatter, 1e-6);
}

TEST(PoolEvidence, OneViewAloneKnowsOnlyThePrior) {
  TriMesh point;
  point.positions.resize(1);
  const SurfaceEvidence lone{1, 0, 0, 0, 0.5f};
  const PooledEvidence p = pool_evidence(point, {&lone, 1})[0];
  EXPECT_TRUE(p.seen);
  EXPECT_NEAR(p.disagreement, 0.1, 1e-6);
  EXPECT_NEAR(p.fine_share, 1, 0.01);
  EXPECT_LT(confidence_of(p, kPhotographs), 0.5);
  EXPECT_GT(confidence_of(p, kPhotographs), 0);
}

TEST(Confidence, IsMonotoneInEveryPieceOfEvidence) {
  const auto at = [](float scatter, float disagreement, float share) {
    return confidence_of({true, scatter, disagreement, share}, kPhotographs);
  };
  for (const float s : {0.0f, 0.2f, 3.0f})
    for (const float d : {0.001f, 0.03f, 0.3f})
      for (const float f : {0.01f, 0.2f, 1.0f}) {
        EXPECT_LT(at(s, d, f), at(s + 0.5f, d, f));
        EXPECT_GT(at(s, d, f), at(s, 1.5f * d, f));
        EXPECT_GT(at(s, d, f), at(s, d, 1.3f * f));
        EXPECT_GT(at(s, d, f), 0);
        EXPECT_LE(at(s, d, f), 1);
        EXPECT_LT(confidence_of({true, s, d, f}, Shaping::kSilhouettes), at(s, d, f));
      }
  EXPECT_GT(at(3, 0.01f, 0.1f), 0.95) << "many views that agree on rich texture";
  EXPECT_LT(at(0.2f, 0.3f, 1), 0.2) << "few views that do not";
}

}  // namespace
}  // namespace photohull::render
