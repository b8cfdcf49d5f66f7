#include "lab/chart/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace photohull::chart {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(ParetoFront, KeepsWhatNothingBeats) {
  const Choice choices[] = {{10, 80}, {5, 60}, {20, 79}, {5, 55}, {40, 95}, {41, 95}};
  EXPECT_THAT(pareto_front(choices), ElementsAre(1, 0, 4));
}

TEST(ParetoFront, KeepsAllOfEqualChoices) {
  const Choice choices[] = {{1, 50}, {1, 50}, {2, 50}};
  EXPECT_THAT(pareto_front(choices), ElementsAre(0, 1));
}

TEST(ParetoFront, OfNothingIsEmpty) { EXPECT_THAT(pareto_front({}), IsEmpty()); }

TEST(FitPowerLaw, FindsTheLawOfExactSamples) {
  std::vector<Sample> samples;
  for (const double x : {64.0, 128.0, 192.0, 256.0}) samples.push_back({x, 3 * std::pow(x, -1.25)});
  const auto law = fit_power_law(samples);
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, -1.25, 1e-12);
  EXPECT_NEAR(law->factor, 3, 1e-10);
  EXPECT_EQ(law->samples, 4);
  EXPECT_NEAR(law->at(100), 3 * std::pow(100, -1.25), 1e-12);
}

TEST(FitPowerLaw, IsTheLeastSquaresInLogarithms) {
  // In logarithms to base 2: (0, 0), (1, 3), (2, 3): slope 3/2, mean 2.
  const Sample samples[] = {{1, 1}, {2, 8}, {4, 8}};
  const auto law = fit_power_law(samples);
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 1.5, 1e-12);
  EXPECT_NEAR(law->factor, std::sqrt(2.0), 1e-12);
}

TEST(FitPowerLaw, LeavesOutWhatHasNoLogarithm) {
  const Sample samples[] = {{1, 2}, {2, 4}, {3, 0}, {0, 5}, {4, -1}, {5, NAN}};
  const auto law = fit_power_law(samples);
  ASSERT_TRUE(law);
  EXPECT_NEAR(law->exponent, 1, 1e-12);
  EXPECT_EQ(law->samples, 2);
}

TEST(FitPowerLaw, NeedsTwoResolutions) {
  const Sample same[] = {{64, 1}, {64, 2}}, one[] = {{64, 1}};
  EXPECT_FALSE(fit_power_law(same));
  EXPECT_FALSE(fit_power_law(one));
}

TEST(MedianIndex, IsTheMiddleOrTheLowerOfTwo) {
  EXPECT_EQ(median_index(std::vector<double>{5, 1, 3}), 2u);
  EXPECT_EQ(median_index(std::vector<double>{5, 1, 3, 9}), 2u);
  EXPECT_EQ(median_index(std::vector<double>{7}), 0u);
}

}  // namespace
}  // namespace photohull::chart
