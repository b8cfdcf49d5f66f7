#include "refine/hull_prior.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace photohull::refine {
namespace {

using glm::vec3;

/// A ball of radius 8 voxels about the middle of a grid of 24.
SparseVolume ball() {
  SparseVolume volume;
  volume.grid = {{0, 0, 0}, 1, {3, 3, 3}};
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x) {
        volume.table.push_back(std::uint32_t(volume.bricks.size()));
        volume.bricks.emplace_back(x, y, z);
        for (int i = 0; i < kBrickVoxels; ++i) {
          const vec3 at(8 * x + (i >> 6), 8 * y + ((i >> 3) & 7), 8 * z + (i & 7));
          volume.distance.push_back(glm::clamp(glm::distance(at, vec3(12)) - 8, -3.0f, 3.0f));
        }
      }
  return volume;
}

/// The peak of a vertex so far under the ball's surface, after the hull has had its say.
Peak pulled(float under, const Peak& peak, float texture, const HullPriorOptions& options = {},
            float trust = 1) {
  const std::vector<vec3> positions = {vec3(12) + (8 - under) * glm::normalize(vec3(1, 2, -0.5))};
  std::vector<Peak> peaks = {peak};
  const VertexGraph alone{{0, 0}, {}};
  pull_to_hull(ball(), alone, positions, {{&texture, 1}, {&trust, 1}}, options, peaks);
  return peaks[0];
}

TEST(PullToHull, WithoutEvidenceTheHullIsThePlace) {
  const Peak peak = pulled(0.5f, {}, 0);
  EXPECT_NEAR(peak.offset, 0.5, 0.1);
  EXPECT_NEAR(peak.weight, 0.5 * HullPriorOptions().weight, 0.1 * HullPriorOptions().weight);
}

TEST(PullToHull, WhatLiesDeeperIsNotItsBusiness) {
  const Peak peak = pulled(1.6f, {-0.7f, 0.4f, 0.6f}, 0);
  EXPECT_FLOAT_EQ(peak.offset, -0.7f);
  EXPECT_FLOAT_EQ(peak.weight, 0.4f);
}

TEST(PullToHull, TheMoreTextureTheLess) {
  const Peak evidence = {-0.5f, 0.1f, 0.9f};
  EXPECT_FLOAT_EQ(pulled(0.2f, evidence, 1).offset, -0.5f);
  EXPECT_NEAR(pulled(0.2f, evidence, 0.9999f).offset, -0.5, 0.03);
  EXPECT_GT(pulled(0.2f, evidence, 0).offset, pulled(0.2f, evidence, 0.5f).offset);
  EXPECT_GT(pulled(0.2f, evidence, 0.5f).offset, -0.3f);
}

// Three vertices in a row, textureless: what the outer two tell keeps the hull from the middle one.
TEST(PullToHull, WherePhotographsTellAroundTheHullHasNoSay) {
  const VertexGraph row{{0, 1, 3, 4}, {1, 0, 2, 1}};
  const std::vector<vec3> positions(3, vec3(12) + 7.8f * glm::normalize(vec3(1, 2, -0.5)));
  const std::vector<float> texture(3, 0), trust(3, 1);
  const auto middle = [&](float weight_beside) {
    std::vector<Peak> peaks(3);
    peaks[0].weight = peaks[2].weight = weight_beside;
    pull_to_hull(ball(), row, positions, {texture, trust}, {.evidence = 0.5}, peaks);
    return peaks[1];
  };
  EXPECT_GT(middle(0).weight, 2);
  EXPECT_LT(middle(0.3f).weight, 0.7f * middle(0).weight);
  EXPECT_GT(middle(0.3f).weight, 0);
  EXPECT_EQ(middle(1).weight, 0);
  EXPECT_EQ(middle(100).weight, 0);
}

TEST(PullToHull, ThinPartsAreThickerInTheHull) {
  const float whole = pulled(0.2f, {}, 0).weight;
  EXPECT_NEAR(pulled(0.2f, {}, 0, {}, 0.5f).weight, 0.25f * whole, 1e-4f * whole);
  EXPECT_EQ(pulled(0.2f, {}, 0, {}, 0).weight, 0);
}

// A plain vertex on the hull, and a thousand that photographs put on it or far under it.
TEST(PullToHull, AHullThatIsLooseElsewhereIsNotBelieved) {
  const auto plain = [](float depth) {
    const std::size_t count = 1001;
    const std::vector<vec3> positions(count, vec3(12) + 7.8f * glm::normalize(vec3(1, 2, -0.5)));
    const std::vector<float> texture(count, 0), trust(count, 1);
    std::vector<Peak> peaks(count, Peak{0.2f - depth, 2, 0.9f});
    peaks[0] = {};
    const VertexGraph apart{std::vector<std::uint32_t>(count + 1, 0), {}};
    pull_to_hull(ball(), apart, positions, {texture, trust}, {}, peaks);
    return peaks[0].weight;
  };
  EXPECT_NEAR(plain(0.1f), 0.8 * HullPriorOptions().weight, 0.1 * HullPriorOptions().weight);
  EXPECT_LT(plain(3), 0.001 * plain(0.1f));
}

// Photographs put a thousand vertices so far under the hull.
TEST(PullToHull, SaysHowFarTheHullIsBelievedAtSmallerVoxels) {
  const auto trust_of = [](double depth, std::optional<double> known, float& weight) {
    const std::size_t count = 1001;
    const std::vector<vec3> positions(count, vec3(12) + 7.8f * glm::normalize(vec3(1, 2, -0.5)));
    const std::vector<float> texture(count, 0), trust(count, 1);
    std::vector<Peak> peaks(count, Peak{float(0.2 - depth), 2, 0.9f});
    peaks[0] = {};
    const VertexGraph apart{std::vector<std::uint32_t>(count + 1, 0), {}};
    HullPriorOptions options;
    options.trust = known;
    const HullTrust out = pull_to_hull(ball(), apart, positions, {texture, trust}, options, peaks);
    weight = peaks[0].weight;
    return out;
  };
  float weight = 0, known = 0;
  const HullTrust trust = trust_of(0.35, std::nullopt, weight);
  EXPECT_NEAR(trust[0], 1, 1e-12) << "within a voxel";
  EXPECT_NEAR(trust[1], 1, 1e-12) << "within a half";
  EXPECT_LT(trust[2], 0.01) << "not within a quarter";
  EXPECT_EQ(trust[4], trust[2]);
  EXPECT_EQ(trust_of(0.35, 0.25, known), trust) << "what it sees";
  EXPECT_NEAR(known, 0.25f * weight, 1e-3f * weight) << "and what it is told";
}

// Photographs tell nothing at these voxels, or put a thousand vertices on the hull.
TEST(PullToHull, WhatLargerVoxelsToldStandsWhereTheseTellLittle) {
  constexpr HullTrust kCoarser = {1, 0.5, 0.25, 0.125, 0.0625};
  const auto pulled_to = [&](std::optional<HullTrust> coarser, std::size_t sure, HullTrust& trust) {
    const std::size_t count = sure + 1;
    const std::vector<vec3> positions(count, vec3(12) + 7.8f * glm::normalize(vec3(1, 2, -0.5)));
    const std::vector<float> texture(count, 0), thick(count, 1);
    std::vector<Peak> peaks(count, Peak{0.2f, 2, 0.9f});
    peaks[0] = {};
    const VertexGraph apart{std::vector<std::uint32_t>(count + 1, 0), {}};
    HullPriorOptions options;
    options.coarser = coarser;
    trust = pull_to_hull(ball(), apart, positions, {texture, thick}, options, peaks);
    return peaks[0].weight;
  };
  HullTrust trust{};
  const float alone = pulled_to(std::nullopt, 0, trust);
  EXPECT_EQ(trust, HullTrust({1, 1, 1, 1, 1}));
  EXPECT_NEAR(pulled_to(kCoarser, 0, trust), 0.5f * alone, 1e-4f * alone);
  for (std::size_t i = 0; i < trust.size(); ++i)
    EXPECT_NEAR(trust[i], kCoarser[std::min(i + 1, trust.size() - 1)], 1e-9) << i;
  EXPECT_GT(pulled_to(kCoarser, 1000, trust), 0.9f * alone) << "these tell much";
}

TEST(PullToHull, NoWeightNoChange) {
  const Peak peak = pulled(0.2f, {}, 0, {.weight = 0});
  EXPECT_EQ(peak.offset, 0);
  EXPECT_EQ(peak.weight, 0);
}

}  // namespace
}  // namespace photohull::refine
