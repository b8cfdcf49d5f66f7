#include "eval/reliability.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "shapes.h"

namespace photohull::eval {
namespace {

using testing::HasSubstr;

template <typename Failure, typename Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const Failure& e) {
    return e.what();
  }
  return "nothing was thrown";
}

TEST(Reliability, KnownAnswers) {
  // Two bins: 0.25 with one of two within, 0.75 with two of two; one vertex is unseen.
  const Reliability r = reliability_of({0.25f, 0.25f, 0.75f, 0.75f, 0}, {0.5, -3, 0.1, -1, 9}, 1);
  EXPECT_EQ(r.seen, 4u);
  EXPECT_EQ(r.unseen, 1u);
  EXPECT_DOUBLE_EQ(r.confidence, 0.5);
  EXPECT_DOUBLE_EQ(r.within, 0.75);
  ASSERT_EQ(r.bins.size(), 10u);
  EXPECT_EQ(r.bins[2].count, 2u);
  EXPECT_DOUBLE_EQ(r.bins[2].confidence, 0.25);
  EXPECT_DOUBLE_EQ(r.bins[2].within, 0.5);
  EXPECT_EQ(r.bins[7].count, 2u);
  EXPECT_DOUBLE_EQ(r.bins[7].within, 1);
  EXPECT_EQ(r.bins[5].count, 0u);
  EXPECT_DOUBLE_EQ(r.calibration_error, 0.25);
  EXPECT_DOUBLE_EQ(r.brier, (0.5625 + 0.0625 + 0.0625 + 0.0625) / 4);
  ASSERT_TRUE(r.auc);
  EXPECT_DOUBLE_EQ(*r.auc, (2 + 0.5) / 3);  // of three pairs one is a tie
  // Ranks 1.5 1.5 3.5 3.5 against 2 4 1 3.
  ASSERT_TRUE(r.spearman);
  EXPECT_NEAR(*r.spearman, -2 / std::sqrt(4.0 * 5), 1e-12);
}

TEST(Reliability, BinsHoldTheirUpperEnd) {
  const Reliability r = reliability_of({0.5f, 1.0f, 1e-6f}, {0, 0, 0}, 1);
  EXPECT_EQ(r.bins[4].count, 1u);
  EXPECT_EQ(r.bins[9].count, 1u);
  EXPECT_EQ(r.bins[0].count, 1u);
  EXPECT_FALSE(r.auc) << "all lie within";
  EXPECT_FALSE(r.spearman) << "all errors are equal";
}

TEST(Reliability, HonestConfidenceIsCalibratedAndItsOppositeIsNot) {
  std::vector<float> honest, opposite;
  std::vector<double> distances;
  for (int i = 0; i < 100000; ++i) {
    const double c = ((i * 7919) % 1000 + 0.5) / 1000;  // every value with every fate
    honest.push_back(float(c));
    opposite.push_back(float(1 - c));
    distances.push_back((i / 1000 + 0.5) / 100 < c ? 0.5 : 2);
  }
  const Reliability good = reliability_of(honest, distances, 1);
  EXPECT_LT(good.calibration_error, 0.01);
  EXPECT_NEAR(good.brier, 1.0 / 6, 0.002);  // the mean of c (1 - c)
  EXPECT_NEAR(*good.auc, 5.0 / 6, 0.005);
  EXPECT_LT(*good.spearman, -0.5);
  const Reliability bad = reliability_of(opposite, distances, 1);
  EXPECT_NEAR(bad.calibration_error, 0.5, 0.01);
  EXPECT_NEAR(*bad.auc, 1.0 / 6, 0.005);
}

TEST(Reliability, MeasuresDistancesOfVertices) {
  TriMesh result = test::plate(0, 0, 0.25, 1, 4);
  result.confidence.assign(result.positions.size(), 0.9f);
  result.confidence[3] = 0;
  result.positions[7].z = 1;  // 1.25 above the truth
  const Truth truth(test::plate(-1, -1, 0, 3, 1));
  Progress silent;
  const Reliability r = measure_reliability(result, truth, 0.3, silent);
  EXPECT_EQ(r.seen, 24u);
  EXPECT_DOUBLE_EQ(r.within, 23.0 / 24);
  EXPECT_EQ(measure_reliability(result, truth, 0.2, silent).within, 0);
  EXPECT_EQ(measure_reliability(result, truth, 2, silent).within, 1);
}

TEST(Reliability, RefusesWhatSaysNothing) {
  TriMesh result = test::plate(0, 0, 0, 1, 1);
  const Truth truth(test::plate(0, 0, 0, 1, 1));
  Progress silent;
  const auto measure = [&](double d) { measure_reliability(result, truth, d, silent); };
  EXPECT_THAT(message_of<Error>([&] { measure(1); }), HasSubstr("no confidence"));
  result.confidence.assign(4, 0);
  EXPECT_THAT(message_of<Error>([&] { measure(1); }), HasSubstr("above 0"));
  result.confidence[2] = 1.5f;
  EXPECT_THAT(message_of<Error>([&] { measure(1); }), HasSubstr("vertex 2 is 1.5"));
  result.confidence[2] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(message_of<Error>([&] { measure(1); }), HasSubstr("vertex 2"));
  result.confidence[2] = 1;
  for (const double d : {0.0, -1.0, std::numeric_limits<double>::infinity()})
    EXPECT_THAT(message_of<UsageError>([&] { measure(d); }), HasSubstr("reliability"));
}

}  // namespace
}  // namespace photohull::eval
