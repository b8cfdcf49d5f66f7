// Labels of space against the reference, and against cuts that are known.
#include "refine/kernels/label_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/grid.h"
#include "support/gl_context.h"

namespace photohull::refine {
namespace {

using glm::dvec3;
using glm::ivec3;

std::vector<ivec3> block(const ivec3& size) {
  std::vector<ivec3> bricks;
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) bricks.emplace_back(x, y, z);
  return bricks;
}

/// Evidence told(voxel) at every voxel of the bricks.
template <typename Told>
std::vector<float> evidence_of(const std::vector<ivec3>& bricks, const Told& told) {
  std::vector<float> out;
  for (const ivec3& brick : bricks)
    for (int i = 0; i < kBrickVoxels; ++i)
      out.push_back(float(told(brick * kBrickEdge + ivec3(i / 64, i / 8 % 8, i % 8))));
  return out;
}

double solid_at(const std::vector<ivec3>& bricks, const std::vector<float>& labels,
                const ivec3& voxel) {
  for (std::size_t b = 0; b < bricks.size(); ++b)
    if (bricks[b] == voxel / kBrickEdge)
      return labels[b * kBrickVoxels + std::size_t(voxel_offset(voxel % kBrickEdge))];
  ADD_FAILURE() << "no such voxel";
  return 0;
}

TEST(LabelSpace, EqualsTheReference) {
  std::mt19937 random(7);
  std::normal_distribution<float> normal;
  // Bricks in no order, with gaps between them.
  std::vector<ivec3> bricks;
  for (const ivec3& brick : block({3, 2, 3}))
    if (random() % 5 != 0) bricks.push_back(brick);
  std::shuffle(bricks.begin(), bricks.end(), random);
  for (const float scale : {0.05f, 1.0f, 1000.0f}) {
    const auto evidence = evidence_of(
        bricks, [&](const ivec3&) { return random() % 3 == 0 ? scale * normal(random) : 0.0f; });
    for (const int iterations : {0, 1, 30}) {
      const auto found = label_space(test::gl_context(), bricks, evidence, iterations);
      const auto right = reference::label_space(bricks, evidence, iterations);
      ASSERT_EQ(found.size(), right.size());
      for (std::size_t i = 0; i < found.size(); ++i)
        ASSERT_NEAR(found[i], right[i], 1e-4) << "scale " << scale << ", voxel " << i;
    }
  }
}

TEST(LabelSpace, NoBricksAndNoEvidence) {
  EXPECT_TRUE(label_space(test::gl_context(), {}, {}, 10).empty());
  const auto bricks = block({2, 1, 1});
  const auto labels = label_space(test::gl_context(), bricks,
                                  evidence_of(bricks, [](const ivec3&) { return 0; }), 10);
  for (const float label : labels) EXPECT_EQ(label, 0);
}

TEST(LabelSpace, AShellIsFilledAndAStrayVoxelGoes) {
  const auto bricks = block({4, 4, 4});
  const dvec3 middle(15.5);
  const auto told = [&](const ivec3& v) {
    const double r = glm::distance(dvec3(v), middle);
    if (v == ivec3(2, 3, 2)) return -0.5;  // one ray's say against six faces
    if (r > 10) return 1.0;                // seen through
    return r > 8 ? -1.0 : 0.02;            // claimed; unknown within
  };
  const auto labels = label_space(test::gl_context(), bricks, evidence_of(bricks, told), 150);
  EXPECT_GT(solid_at(bricks, labels, {15, 15, 15}), 0.9);
  EXPECT_GT(solid_at(bricks, labels, {15, 15, 7}), 0.9);
  EXPECT_LT(solid_at(bricks, labels, {2, 3, 2}), 0.1);
  EXPECT_LT(solid_at(bricks, labels, {1, 15, 15}), 0.1);
}

TEST(LabelSpace, AHoleOfTheShellIsSpannedByTheSmallestSurface) {
  const auto bricks = block({4, 4, 4});
  const dvec3 middle(15.5);
  const auto told = [&](const ivec3& v) {
    const dvec3 p = dvec3(v) - middle;
    const double r = glm::length(p);
    if (p.z > 7 && std::hypot(p.x, p.y) < 5) return 0.0;  // nothing is known around the pole
    if (r > 10) return 1.0;
    return r > 8 ? -1.0 : 0.02;
  };
  const auto labels = label_space(test::gl_context(), bricks, evidence_of(bricks, told), 150);
  EXPECT_GT(solid_at(bricks, labels, {15, 15, 15}), 0.9);
  EXPECT_GT(solid_at(bricks, labels, {15, 15, 21}), 0.9);
  EXPECT_LT(solid_at(bricks, labels, {15, 15, 30}), 0.1);
}

TEST(LabelSpace, WhatIsUnknownIsNotSolid) {
  // A wall that is seen from one side: nothing is known behind it.
  const auto bricks = block({4, 2, 2});
  const auto told = [](const ivec3& v) { return v.x < 10 ? 1.0 : v.x < 13 ? -1.0 : 0.2; };
  const auto labels = label_space(test::gl_context(), bricks, evidence_of(bricks, told), 150);
  EXPECT_LT(solid_at(bricks, labels, {8, 8, 8}), 0.1);
  EXPECT_GT(solid_at(bricks, labels, {11, 8, 8}), 0.9);
  EXPECT_LT(solid_at(bricks, labels, {20, 8, 8}), 0.1);
}

}  // namespace
}  // namespace photohull::refine
