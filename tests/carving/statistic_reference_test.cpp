// What the statistics say of patches whose truth is known.
#include "carving/statistic_reference.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/parse_name.h"
#include "support/cameras.h"

namespace photohull::carving::reference {
namespace {

constexpr ImageNoise kNoise{1e-4, 2.25e-4};
constexpr double kKeep = 0.7;

/// Those whose references take patches.
std::vector<StatisticEntry> of_patches() {
  std::vector<StatisticEntry> out;
  for (const StatisticEntry& entry : statistic_entries())
    if (entry.reference) out.push_back(entry);
  return out;
}

std::vector<glm::dvec3> random_patch(test::Rng& rng) {
  std::vector<glm::dvec3> patch(25);
  for (glm::dvec3& x : patch)
    for (int c = 0; c < 3; ++c) x[c] = test::uniform(rng, 0.1, 0.9);
  return patch;
}

/// The same patch in `n` views, with gains and with noise of the images' own size.
CommonPatches same(test::Rng& rng, int n, double least_gain = 1) {
  const std::vector<glm::dvec3> pattern = random_patch(rng);
  std::normal_distribution<double> noise(0, std::sqrt(kNoise.variance));
  CommonPatches out;
  out.middle = 12;
  for (int v = 0; v < n; ++v) {
    out.views.push_back(pattern);
    const double gain = test::uniform(rng, least_gain, 1);
    for (glm::dvec3& x : out.views.back())
      for (int c = 0; c < 3; ++c) x[c] = gain * x[c] + noise(rng);
  }
  return out;
}

CommonPatches different(test::Rng& rng, int n) {
  CommonPatches out;
  out.middle = 12;
  for (int v = 0; v < n; ++v) out.views.push_back(random_patch(rng));
  return out;
}

TEST(Statistics, AgreeOnTheSameSurfaceAndNotOnDifferentOnes) {
  test::Rng rng(3);
  for (const StatisticEntry& statistic : of_patches()) {
    int kept = 0, refused = 0;
    for (int i = 0; i < 50; ++i) {
      const Evidence good = statistic.reference(same(rng, 5), kNoise);
      kept += good.score >= kKeep && good.confidence > 0.5;
      refused += statistic.reference(different(rng, 5), kNoise).score < kKeep;
    }
    EXPECT_EQ(kept, 50) << statistic.name;
    EXPECT_GE(refused, 45) << statistic.name;
  }
}

TEST(Statistics, GainsOfTheViewsAreFoundOut) {
  test::Rng rng(5);
  const CommonPatches patches = same(rng, 6, 0.5);
  EXPECT_GT(gain_variance(patches, kNoise).score, 0.9);
  EXPECT_GT(census(patches, kNoise).score, 0.9);
  // A residual of pure noise is the noise's variance, whatever the gains.
  EXPECT_NEAR((1 - gain_variance(patches, {kNoise.variance, 0}).score) / 0.3,
              kNoise.variance / (4 * kNoise.variance + 0.25 * 0.035), 0.01);
}

TEST(Statistics, ATrimmedVarianceBearsOneViewInThree) {
  test::Rng rng(7);
  CommonPatches patches = same(rng, 6);
  patches.views[1] = random_patch(rng);
  patches.views[4] = random_patch(rng);
  const Evidence robust = robust_variance(patches, kNoise);
  EXPECT_GT(robust.score, 0.9);
  EXPECT_EQ(robust.used, 4);
  EXPECT_LT(gain_variance(patches, kNoise).score, kKeep);
}

TEST(Statistics, PlainPatchesSayNothingWhereContrastIsCompared) {
  CommonPatches plain;
  plain.views.assign(5, std::vector<glm::dvec3>(25, glm::dvec3(0.4)));
  plain.middle = 12;
  for (const Statistic statistic :
       {Statistic::kGainVariance, Statistic::kHistogram, Statistic::kCensus})
    EXPECT_EQ(entry_of(statistic).reference(plain, kNoise).confidence, 0) << to_string(statistic);
  // Colours alone can still tell, by differing.
  plain.views[2].assign(25, glm::dvec3(0.7));
  EXPECT_LT(adaptive_variance(plain, kNoise).score, 0);
}

TEST(Statistics, TooFewViewsOrTapsAreNoEvidence) {
  test::Rng rng(9);
  CommonPatches few = same(rng, 4);
  for (auto& view : few.views) view.resize(12);
  few.middle = 3;
  for (const StatisticEntry& statistic : of_patches()) {
    EXPECT_EQ(statistic.reference(same(rng, 1), kNoise).confidence, 0);
    EXPECT_EQ(statistic.reference({}, kNoise).confidence, 0);
    EXPECT_EQ(statistic.reference(few, kNoise).confidence, 0);
  }
}

TEST(StatisticNames, AreReadBackAndOthersRefused) {
  for (const Statistic statistic : all_statistics())
    EXPECT_EQ(parse_name("--consistency", to_string(statistic), all_statistics()), statistic);
  EXPECT_THROW(parse_name("--consistency", "mean", all_statistics()), UsageError);
}

}  // namespace
}  // namespace photohull::carving::reference
