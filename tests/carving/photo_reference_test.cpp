// The references themselves, against cases that can be worked out by hand.
#include "carving/photo_reference.h"

#include <gtest/gtest.h>

#include "support/cameras.h"

namespace photohull::carving::reference {
namespace {

Patch random_patch(test::Rng& rng) {
  Patch patch;
  for (glm::dvec3& colour : patch)
    colour = {test::uniform(rng, 0, 1), test::uniform(rng, 0, 1), test::uniform(rng, 0, 1)};
  return patch;
}

Patch scaled(Patch patch, double gain, double offset) {
  for (glm::dvec3& colour : patch) colour = gain * colour + offset;
  return patch;
}

TEST(PhotoConsistency, OfPatchesThatDifferByGainAndOffsetIsOne) {
  test::Rng rng(1);
  const Patch patch = random_patch(rng);
  const std::vector<Patch> patches{patch, scaled(patch, 0.3, 0.2), scaled(patch, 2, -1)};
  const Consistency c = photo_consistency(patches, 0);
  EXPECT_NEAR(c.score, 1, 1e-12);
  EXPECT_EQ(c.used, 3);
}

TEST(PhotoConsistency, OfANegativeIsMinusOne) {
  test::Rng rng(2);
  const Patch patch = random_patch(rng);
  const std::vector<Patch> patches{patch, scaled(patch, -1, 1)};
  // No view agrees: both are dropped, and the score is the least one.
  EXPECT_EQ(photo_consistency(patches, 0).score, -1);
}

TEST(PhotoConsistency, TheNoiseFloorHalvesTheScoreOfPatchesAsFlatAsTheNoise) {
  Patch patch;
  for (int tap = 0; tap < kPatchTaps; ++tap) patch[tap] = glm::dvec3(tap < 12 ? 0.4 : 0.6);
  const double mean = (12 * 0.4 + 13 * 0.6) / 25;
  const double variance = (12 * std::pow(0.4 - mean, 2) + 13 * std::pow(0.6 - mean, 2)) / 25;
  const std::vector<Patch> patches{patch, patch};
  const Consistency c = photo_consistency(patches, variance);
  EXPECT_NEAR(c.texture, variance, 1e-12);
  EXPECT_NEAR(c.score, 0.5, 1e-12);
}

TEST(PhotoConsistency, DropsTheOutlier) {
  test::Rng rng(3);
  const Patch patch = random_patch(rng);
  const std::vector<Patch> patches{patch, random_patch(rng), patch, patch};
  const Consistency c = photo_consistency(patches, 0);
  EXPECT_EQ(c.used, 3);
  EXPECT_EQ(c.seen, 4);
  EXPECT_NEAR(c.score, 1, 1e-12);
}

TEST(PhotoConsistency, OfTooFewViewsIsTheLeast) {
  test::Rng rng(4);
  EXPECT_EQ(photo_consistency(std::span<const Patch>{}, 1e-4).score, -1);
  const std::vector<Patch> one{random_patch(rng)};
  EXPECT_EQ(photo_consistency(one, 1e-4).score, -1);
}

// ---- ColumnJudge: one score a layer, 'x' layers are empty ------------------------------------

constexpr JudgeRules kRules{0.6, 0.15, 3, 1e-4, 8};
constexpr double kEmpty = -9;

std::vector<Decision> judge(const std::vector<double>& column, const JudgeRules& rules = kRules) {
  std::vector<std::uint8_t> standing;
  std::vector<Consistency> scores;
  for (const double score : column) {
    standing.push_back(score != kEmpty);
    Consistency c;
    c.score = score;
    c.seen = 4;
    c.texture = 1e-3;
    scores.push_back(c);
  }
  return ColumnJudge(rules, standing, scores).decisions({3, 5});
}

void expect_decision(const Decision& d, int bare, int surface, Outcome outcome) {
  EXPECT_EQ(d.column, glm::ivec2(3, 5));
  EXPECT_EQ(d.bare, bare);
  EXPECT_EQ(d.surface, surface);
  EXPECT_EQ(d.outcome, outcome);
}

TEST(ColumnJudge, AConsistentBareVoxelStays) {
  const auto decisions = judge({kEmpty, 0.7, 0.9, 0.1, kEmpty});
  ASSERT_EQ(decisions.size(), 1u);
  expect_decision(decisions[0], 1, 1, Outcome::kKept);
}

TEST(ColumnJudge, ThePeakBehindIsTheSurface) {
  const auto decisions = judge({kEmpty, 0.1, 0.2, 0.65, 0.9, 0.7, 0.1, 0.95, 0.1, kEmpty});
  ASSERT_EQ(decisions.size(), 1u);
  expect_decision(decisions[0], 1, 4, Outcome::kBetter);
  EXPECT_FLOAT_EQ(decisions[0].score, 0.1f);
  EXPECT_FLOAT_EQ(decisions[0].best_score, 0.9f);
}

TEST(ColumnJudge, NothingBetterBehindLeavesItUndecided) {
  const auto decisions = judge({kEmpty, 0.1, 0.2, 0.55, 0.3, kEmpty});
  ASSERT_EQ(decisions.size(), 1u);
  expect_decision(decisions[0], 1, 1, Outcome::kUndecided);
  EXPECT_FLOAT_EQ(decisions[0].best_score, 0.55f);
}

TEST(ColumnJudge, AGainThatIsTooSmallLeavesItUndecided) {
  const auto decisions = judge({kEmpty, 0.5, 0.62, 0.3, 0.2, 0.1, kEmpty});
  ASSERT_EQ(decisions.size(), 1u);
  expect_decision(decisions[0], 1, 1, Outcome::kUndecided);
}

TEST(ColumnJudge, EmptySpaceEndsThePathAndBaresTheNextVoxel) {
  const auto decisions = judge({0.1, 0.2, kEmpty, 0.9, 0.1, kEmpty});
  ASSERT_EQ(decisions.size(), 2u);
  expect_decision(decisions[0], 0, 0, Outcome::kUndecided);
  expect_decision(decisions[1], 3, 3, Outcome::kKept);
}

TEST(ColumnJudge, ThePathEndsAtItsLongest) {
  std::vector<double> column(20, 0.1);
  column[10] = 0.9;
  column.push_back(kEmpty);
  // The path from layer 0 reaches layer 8.
  expect_decision(judge(column).at(0), 0, 0, Outcome::kUndecided);
  JudgeRules longer = kRules;
  longer.max_path = 10;
  expect_decision(judge(column, longer).at(0), 0, 10, Outcome::kBetter);
}

TEST(ColumnJudge, FewViewsOrLittleTextureTellNothing) {
  std::vector<std::uint8_t> standing{1, 1, 0};
  std::vector<Consistency> scores(3);
  scores[0].score = 0.1;
  scores[0].seen = 2;
  scores[0].texture = 1;
  auto decisions = ColumnJudge(kRules, standing, scores).decisions({3, 5});
  ASSERT_EQ(decisions.size(), 1u);
  expect_decision(decisions[0], 0, 0, Outcome::kUnseen);
  scores[0].seen = 5;
  scores[0].texture = 1e-5;
  decisions = ColumnJudge(kRules, standing, scores).decisions({3, 5});
  expect_decision(decisions.at(0), 0, 0, Outcome::kUnseen);
}

TEST(ColumnJudge, AnEmptyColumnNeedsNoDecision) {
  EXPECT_TRUE(judge({kEmpty, kEmpty, kEmpty}).empty());
  EXPECT_TRUE(judge({}).empty());
}

TEST(SweepFrame, LayersCountFromWhereTheSweepBegins) {
  const SweepFrame forth{1, 1, {8, 16, 24}}, back{1, -1, {8, 16, 24}};
  // Axes in the plane: z, then x.
  EXPECT_EQ(forth.voxel({5, 3}, 2), glm::ivec3(3, 2, 5));
  EXPECT_EQ(back.voxel({5, 3}, 2), glm::ivec3(3, 13, 5));
}

}  // namespace
}  // namespace photohull::carving::reference
