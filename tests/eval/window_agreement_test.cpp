#include "eval/window_agreement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/error.h"

namespace photohull::eval {
namespace {

constexpr int kWindow = 7;
constexpr double kFloor = 0.03 * 0.03;

/// Independent random values in both pictures; all pixels count and are predicted.
PicturePair random_pair(int width, int height, float spread, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(0.5f - spread, 0.5f + spread);
  PicturePair pair{width, height, {}, {}, {}, {}};
  for (int i = 0; i < width * height; ++i) {
    pair.photo.emplace_back(value(random), value(random), value(random));
    pair.prediction.emplace_back(value(random), value(random), value(random));
  }
  pair.counts.assign(pair.photo.size(), 1);
  pair.predicted = pair.counts;
  return pair;
}

TEST(WindowAgreement, SamePicturesUpToGainAndOffsetAgree) {
  PicturePair pair = random_pair(20, 15, 0.3f);
  for (std::size_t i = 0; i < pair.photo.size(); ++i)
    pair.prediction[i] = 0.7f * pair.photo[i] + glm::vec3(0.1f, 0.2f, -0.05f);
  for (const float score : window_agreement(pair, kWindow, kFloor)) EXPECT_NEAR(score, 1, 1e-4);
  for (std::size_t i = 0; i < pair.photo.size(); ++i) pair.prediction[i] = 1.0f - pair.photo[i];
  for (const float score : window_agreement(pair, kWindow, kFloor)) EXPECT_NEAR(score, -1, 1e-4);
}

// By hand: a window of 3 x 3 with one channel of the photograph as a ramp, the prediction's as a
// ramp and noise orthogonal to it.
TEST(WindowAgreement, IsTheFormula) {
  PicturePair pair = random_pair(3, 3, 0);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) {
      pair.photo[3 * y + x] = glm::vec3(0.1f * float(x), 0, 0);
      pair.prediction[3 * y + x] = glm::vec3(0.1f * float(x), 0.2f * float(y), 0);
    }
  // Per channel: var a = (.1^2 * 6 / 27), cov the same, var b that + .2^2 * 6 / 27.
  const double ramp = 0.01 * 6 / 27;
  const float centre = window_agreement(pair, 3, 1e-6)[4];
  EXPECT_NEAR(centre, ramp / std::sqrt(ramp * 5 * ramp), 1e-5);
  // A floor between the two variances takes the photograph's place.
  EXPECT_NEAR(window_agreement(pair, 3, ramp)[4], centre, 1e-5);
  EXPECT_TRUE(std::isnan(window_agreement(pair, 3, 1.01 * ramp)[4]));
}

TEST(WindowAgreement, ChanceDoesNotCount) {
  double sum = 0, squares = 0;
  const PicturePair pair = random_pair(60, 60, 0.3f);
  for (const float score : window_agreement(pair, kWindow, kFloor)) {
    sum += double(score);
    squares += double(score) * double(score);
  }
  EXPECT_NEAR(sum / 3600, 0, 0.02);
  EXPECT_NEAR(std::sqrt(squares / 3600), 1 / std::sqrt(3.0 * 49), 0.03);
  // Plain photographs tell nothing; a plain prediction of a textured one is worth nothing, even
  // where what is left of its texture correlates.
  for (const float score : window_agreement(random_pair(20, 20, 0.02f), kWindow, kFloor))
    EXPECT_TRUE(std::isnan(score));
  PicturePair faint = random_pair(20, 20, 0.3f);
  for (std::size_t i = 0; i < faint.photo.size(); ++i)
    faint.prediction[i] = glm::vec3(0.5f) + 0.005f * faint.photo[i];
  for (const float score : window_agreement(faint, kWindow, kFloor)) {
    EXPECT_GT(score, 0);
    EXPECT_LT(score, 0.1);
  }
}

TEST(WindowAgreement, WhatIsJudgedDependsOnThePhotographAlone) {
  PicturePair pair = random_pair(40, 20, 0.3f);
  pair.prediction = pair.photo;
  for (int i = 0; i < 800; ++i) pair.counts[i] = i % 40 < 30;
  const std::vector<float> whole = window_agreement(pair, kWindow, kFloor);
  for (int i = 0; i < 800; ++i) pair.predicted[i] = i % 40 < 20;
  const std::vector<float> part = window_agreement(pair, kWindow, kFloor);
  for (int i = 0; i < 800; ++i) {
    ASSERT_EQ(std::isnan(whole[i]), i % 40 >= 30) << i;
    ASSERT_EQ(std::isnan(part[i]), std::isnan(whole[i])) << i;
    if (i % 40 < 30) {
      ASSERT_NEAR(part[i], i % 40 < 20 ? 1 : 0, 1e-4) << i;
    }
  }
}

TEST(WindowAgreement, StopsWhenAskedTo) {
  EXPECT_THROW(
      window_agreement(random_pair(20, 20, 0.3f), kWindow, kFloor, [] { throw Cancelled(); }),
      Cancelled);
}

TEST(WindowAgreement, NeedsEnoughOfTheWindow) {
  PicturePair pair = random_pair(21, 21, 0.3f);
  pair.prediction = pair.photo;
  const std::size_t centre = 10 * 21 + 10;
  const auto keep = [&](std::vector<std::uint8_t>& flags, int columns) {
    for (int i = 0; i < 441; ++i) flags[i] = std::abs(i % 21 - 10) <= columns;
  };
  keep(pair.counts, 1);  // 3 of 7 columns
  EXPECT_NEAR(window_agreement(pair, kWindow, kFloor)[centre], 1, 1e-4);
  keep(pair.counts, 0);  // 1 of 7: less than a quarter
  EXPECT_TRUE(std::isnan(window_agreement(pair, kWindow, kFloor)[centre]));
  keep(pair.counts, 20);
  keep(pair.predicted, 2);  // 5 of 7
  EXPECT_NEAR(window_agreement(pair, kWindow, kFloor)[centre], 1, 1e-4);
  keep(pair.predicted, 1);  // 3 of 7: less than half
  EXPECT_EQ(window_agreement(pair, kWindow, kFloor)[centre], 0);
}

}  // namespace
}  // namespace photohull::eval
