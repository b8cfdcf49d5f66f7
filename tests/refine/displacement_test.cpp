#include "refine/displacement.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace photohull::refine {
namespace {

constexpr float kNone = kNoScore;

/// A row of vertices, each joined to the next, and one by itself at the end.
VertexGraph row_of(std::uint32_t count) {
  VertexGraph graph;
  graph.first = {0};
  for (std::uint32_t i = 0; i < count; ++i) {
    if (i > 0) graph.neighbours.push_back(i - 1);
    if (i + 1 < count) graph.neighbours.push_back(i + 1);
    graph.first.push_back(std::uint32_t(graph.neighbours.size()));
  }
  graph.first.push_back(graph.first.back());
  return graph;
}

Matches matches_of(const std::vector<std::vector<float>>& curves, double first = -1,
                   double step = 0.5) {
  Matches out;
  out.range = {first, step, int(curves.front().size())};
  out.texture.assign(curves.size(), 1);
  for (const auto& curve : curves) out.scores.insert(out.scores.end(), curve.begin(), curve.end());
  return out;
}

TEST(Aggregate, MixesWithTheMeanOfTheNeighbours) {
  Matches m = matches_of({{0.1f, 0.2f}, {0.5f, 0.6f}, {0.3f, -0.2f}, {0.9f, 0.8f}});
  aggregate(row_of(3), 1, m);
  const float expected[] = {0.3f, 0.4f, 0.35f, 0.3f, 0.4f, 0.2f, 0.9f, 0.8f};
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(m.scores[std::size_t(i)], expected[i], 1e-6) << i;
}

TEST(Aggregate, UnknownScoresTakeNoPart) {
  Matches m = matches_of({{0.4f, 0.2f}, {kNone, kNone}, {0.8f, 0}, {kNone, kNone}});
  aggregate(row_of(3), 1, m);
  const float expected[] = {0.4f, 0.2f, 0.6f, 0.1f, 0.8f, 0, kNone, kNone};
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(m.scores[std::size_t(i)], expected[i], 1e-6) << i;
}

TEST(Aggregate, PassesFollowEachOther) {
  const std::vector<std::vector<float>> curves = {{1, 0}, {kNone, kNone}, {kNone, kNone}, {0, 1}};
  Matches none = matches_of(curves), two = none, once = none;
  aggregate(row_of(3), 0, none);
  EXPECT_EQ(none.scores, matches_of(curves).scores);
  aggregate(row_of(3), 1, once);
  EXPECT_EQ(once.of(2)[0], kNone);
  aggregate(row_of(3), 2, two);
  EXPECT_EQ(two.of(2)[0], 1);
  aggregate(row_of(3), 1, once);
  EXPECT_EQ(once.scores, two.scores);
}

/// A parabola of height `top` at `at`, sampled at 7 offsets from -1.5 in steps of a half.
std::vector<float> parabola(double at, double top, double curvature) {
  std::vector<float> out;
  for (int i = 0; i < 7; ++i)
    out.push_back(float(top - 0.5 * curvature * std::pow(-1.5 + 0.5 * i - at, 2)));
  return out;
}

Peak peak_of(const std::vector<float>& curve, const PeakOptions& options = {}) {
  return find_peaks(matches_of({curve}, -1.5), options).at(0);
}

TEST(FindPeaks, ExactForAParabola) {
  for (const double at : {-0.9, -0.5, -0.13, 0.0, 0.24, 0.26, 0.77}) {
    const Peak peak = peak_of(parabola(at, 0.9, 0.6));
    EXPECT_NEAR(peak.offset, at, 1e-5);
    EXPECT_NEAR(peak.score, 0.9, 0.02);
    EXPECT_GT(peak.weight, 0.5);
    EXPECT_LE(peak.weight, 1);
  }
}

TEST(FindPeaks, NoneAtTheEndsNorOnAPlain) {
  for (const std::vector<float>& curve :
       {parabola(-2, 0.9, 0.4), parabola(2, 0.9, 0.4), parabola(0, 0.9, 0), parabola(0, 0.9, -0.4),
        std::vector<float>(7, kNone)}) {
    const Peak peak = peak_of(curve);
    EXPECT_EQ(peak.weight, 0);
    EXPECT_EQ(peak.offset, 0);
  }
}

TEST(FindPeaks, APlateauOfTwoLiesBetween) {
  EXPECT_NEAR(peak_of({0, 0, 0.5f, 0.8f, 0.8f, 0.5f, 0}).offset, 0.25, 1e-6);
}

TEST(FindPeaks, WeightGrowsWithScoreLeadAndSharpness) {
  const float sure = peak_of(parabola(0, 0.9, 1)).weight;
  EXPECT_NEAR(sure, 1, 1e-6);
  EXPECT_EQ(peak_of(parabola(0, 0.29, 1)).weight, 0) << "below the least score";
  EXPECT_NEAR(peak_of(parabola(0, 0.55, 1)).weight, 0.5, 1e-5) << "half way to sure";
  const float rival = peak_of({0.85f, 0.1f, 0.1f, 0.9f, 0.1f, 0.1f, 0.1f}).weight;
  EXPECT_NEAR(rival, 0.5, 1e-5) << "half the lead that is distinct";
  const float blunt = peak_of(parabola(0, 0.9, 0.05)).weight;
  EXPECT_LT(blunt, 0.5);
  EXPECT_GT(blunt, 0);
}

// Correlations of patches whose variance is half noise reach one half at best.
TEST(FindPeaks, NoiseThatIsKnownIsTakenOffTheScore) {
  Matches m =
      matches_of({parabola(0, 0.4, 0.4), parabola(0, 0.4, 0.4), parabola(0, 0.4, 0.4)}, -1.5);
  m.texture = {1, 0.6f, 0.1f};
  const std::vector<Peak> peaks = find_peaks(m, {});
  EXPECT_NEAR(peaks[1].weight / peaks[0].weight, (0.4 / 0.6 - 0.3) / (0.4 - 0.3), 0.01);
  EXPECT_NEAR(peaks[2].weight / peaks[0].weight, (0.4 / 0.9 - 0.3) / (0.4 - 0.3), 0.01);
  EXPECT_FLOAT_EQ(peaks[2].score, 0.4f);
}

TEST(FindPeaks, TheBestOfSeveral) {
  const Peak peak = peak_of({0.1f, 0.6f, 0.1f, 0.2f, 0.3f, 0.8f, 0.2f});
  EXPECT_NEAR(peak.offset, 1, 0.1);
  EXPECT_FLOAT_EQ(peak.score, 0.8f);
}

TEST(FindPeaks, NothingFromNothing) {
  Matches m;
  m.range = {-1, 0.5, 5};
  EXPECT_TRUE(find_peaks(m, {}).empty());
}

/// Regularizes on a row along x whose normals are z, at these heights or flat.
std::vector<float> regularized(const VertexGraph& graph, const std::vector<Peak>& peaks,
                               const RegularizeOptions& options = {},
                               std::vector<float> heights = {}) {
  heights.resize(peaks.size(), 0.0f);
  std::vector<glm::vec3> positions;
  for (std::size_t i = 0; i < peaks.size(); ++i) positions.emplace_back(i, 0, heights[i]);
  const std::vector<glm::vec3> normals(peaks.size(), {0, 0, 1});
  return regularize(graph, peaks, positions, normals, std::vector<float>(peaks.size(), 1.0f),
                    options);
}

TEST(Regularize, ConstantFieldIsReproduced) {
  const std::vector<Peak> peaks(51, Peak{0.7f, 1, 1});
  for (const float d : regularized(row_of(50), peaks)) EXPECT_NEAR(d, 0.7, 0.002);
}

TEST(Regularize, UnknownVerticesFollowTheirNeighbours) {
  std::vector<Peak> peaks(11, Peak{0.5f, 1, 1});
  for (std::size_t i = 4; i < 7; ++i) peaks[i] = {};
  peaks[10] = {};  // by itself
  RegularizeOptions options;
  options.iterations = 200;
  const std::vector<float> d = regularized(row_of(10), peaks, options);
  for (std::size_t i = 0; i < 10; ++i) EXPECT_NEAR(d[i], 0.5, 0.02) << i;
  EXPECT_EQ(d[10], 0);
}

TEST(Regularize, IsolatedVertexGoesToItsPeak) {
  std::vector<Peak> peaks(3);
  peaks[2] = {1.25f, 0.8f, 1};
  EXPECT_NEAR(regularized(row_of(2), peaks)[2], 1.25, 0.01);
}

TEST(Regularize, OutliersAreRejected) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> noise(-0.1f, 0.1f);
  std::vector<Peak> peaks(101);
  for (std::size_t i = 0; i < 100; ++i)
    peaks[i] = {i % 10 == 5 ? 3.0f : 0.2f + noise(random), 1, 1};
  RegularizeOptions robust, plain;
  plain.robust = 1e6;
  robust.reweightings = plain.reweightings = 5;
  const std::vector<float> d = regularized(row_of(100), peaks, robust),
                           pulled = regularized(row_of(100), peaks, plain);
  for (std::size_t i = 5; i < 100; i += 10) {
    EXPECT_LT(std::abs(d[i] - 0.2f), 0.3f);
    EXPECT_GT(std::abs(pulled[i] - 0.2f), 1.0f);
  }
}

TEST(Regularize, MembraneSmooths) {
  std::vector<Peak> peaks(101);
  for (std::size_t i = 0; i < 100; ++i) peaks[i] = {i % 2 ? 0.5f : -0.5f, 1, 1};
  RegularizeOptions stiff, loose;
  stiff.membrane = 10;
  loose.membrane = 0.01;
  loose.fairing = 0;
  EXPECT_LT(std::abs(regularized(row_of(100), peaks, stiff)[50]), 0.1f);
  EXPECT_GT(std::abs(regularized(row_of(100), peaks, loose)[50]), 0.45f);
}

TEST(Regularize, FairingLowersWhatStandsOut) {
  const std::vector<Peak> unknown(11);
  RegularizeOptions none, fair;
  none.fairing = 0;
  fair.fairing = 1;
  fair.iterations = none.iterations = 100;
  const std::vector<float> spike = {0, 0, 0, 0, 0, 1, 0, 0, 0, 0};
  EXPECT_EQ(regularized(row_of(10), unknown, none, spike)[5], 0);
  const std::vector<float> d = regularized(row_of(10), unknown, fair, spike);
  EXPECT_LT(d[5], -0.1f);
  EXPECT_GT(d[5], -1.0f);
  EXPECT_GT(d[4], d[5]);
  for (const float flat : regularized(row_of(10), unknown, fair)) EXPECT_EQ(flat, 0);
}

TEST(Regularize, FairingKeepsAnEvenCurve) {
  std::vector<Peak> ends(31);
  for (std::size_t i = 0; i < 31; ++i)
    if (i < 4 || i > 26) ends[i] = {0, 1, 1};
  RegularizeOptions options;
  options.fairing = 5;
  options.iterations = 300;
  std::vector<float> arc(31);
  for (int i = 0; i < 31; ++i) arc[std::size_t(i)] = -0.02f * float((i - 15) * (i - 15));
  const std::vector<float> d = regularized(row_of(30), ends, options, arc);
  for (std::size_t i = 8; i < 23; ++i) EXPECT_NEAR(d[i], 0, 0.15) << i;
}

}  // namespace
}  // namespace photohull::refine
