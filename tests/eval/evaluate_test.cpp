#include "eval/evaluate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "eval/evaluation_json.h"
#include "shapes.h"

namespace photohull::eval {
namespace {

using test::plate;
using testing::HasSubstr;

EvaluateOptions few(int samples = 20000) {
  EvaluateOptions options;
  options.samples = samples;
  options.columns = 128;
  return options;
}

TEST(Evaluate, TheTruthItselfIsPerfect) {
  for (const glm::dvec3& far : {glm::dvec3(0), glm::dvec3(1e6, -2e6, 3e5)}) {
    const TriMesh mesh = test::sphere(far, 2, 4);
    const Evaluation e = evaluate(mesh, Truth(mesh), few());
    EXPECT_LT(e.all.to_truth.max, 1e-6 * e.truth_diagonal);
    EXPECT_LT(e.to_result.max, 1e-6 * e.truth_diagonal);
    for (const Score& s : e.all.scores) EXPECT_EQ(s.f, 1) << s.threshold;
    EXPECT_EQ(e.completeness, 1);
    EXPECT_EQ(e.seen.share, 1);
    EXPECT_LT(e.all.normals->mean, 0.01);
    ASSERT_TRUE(e.volume.known) << e.volume.reason;
    EXPECT_NEAR(e.volume.iou, 1, 1e-9);
    EXPECT_TRUE(e.warnings.empty());
  }
}

TEST(Evaluate, AShiftedPlateIsOffByTheShift) {
  const double d = 0.125;
  const Truth truth(plate(-50, -50, 0, 100, 10));
  EvaluateOptions options = few();
  options.absolute = {d - 1e-6, d + 1e-6};
  const Evaluation above = evaluate(plate(-50, -50, d, 100, 7), truth, options);
  for (const double value :
       {above.all.accuracy, above.all.to_truth.mean, above.all.to_truth.median,
        above.all.to_truth.rms, above.all.to_truth.max, above.all.mean_signed.value(),
        above.to_result.mean, above.hausdorff95, above.chamfer})
    EXPECT_NEAR(value, d, 1e-6);
  EXPECT_EQ(above.all.absolute[0].f, 0);
  EXPECT_EQ(above.all.absolute[1].f, 1);
  EXPECT_NEAR(above.all.absolute[1].threshold, d / (100 * std::sqrt(2)), 1e-7);
  EXPECT_NEAR(above.all.normals->mean, 0, 1e-6);
  const Evaluation below = evaluate(plate(-50, -50, -d, 100, 7), truth, options);
  EXPECT_NEAR(below.all.mean_signed.value(), -d, 1e-6);
  EXPECT_FALSE(below.volume.known);
}

TEST(Evaluate, PointsAsTruthGiveDistancesWithoutSigns) {
  TriMesh points = test::sphere({1, 2, 3}, 1, 6);
  points.triangles.clear();
  const Truth truth(points);
  const Evaluation e = evaluate(test::sphere({1, 2, 3}, 1.05, 6), truth, few());
  EXPECT_TRUE(e.truth_is_points);
  EXPECT_NEAR(e.all.to_truth.median, 0.05, 2e-3);  // the points are 0.02 apart
  EXPECT_NEAR(e.to_result.median, 0.05, 3e-4);
  EXPECT_NEAR(e.chamfer, 0.05, 2e-3);
  EXPECT_FALSE(e.all.mean_signed);
  EXPECT_FALSE(e.all.normals);
  EXPECT_THAT(e.volume.reason, HasSubstr("the truth has no faces"));
  const auto j = nlohmann::json::parse(to_json(e));
  EXPECT_EQ(j["truth_mode"], "points");
  EXPECT_TRUE(j["mean_signed"].is_null());
  EXPECT_EQ(j["gt_faces"], 0);
  // Half of the result is missing: so are half of the points.
  TriMesh half = test::sphere({1, 2, 3}, 1, 6);
  std::erase_if(half.triangles, [&](const auto& t) { return half.positions[t[0]].z < 0; });
  const Evaluation missing = evaluate(half, truth, few());
  EXPECT_NEAR(missing.completeness, 0.5, 0.03);
  EXPECT_GT(missing.all.scores[3].precision, 0.95);
}

TEST(Evaluate, FramesThatHaveNothingToDoWithEachOtherAreTold) {
  const Truth truth(test::sphere({1, 2, 3}, 1, 4));
  const auto warnings = [&](const TriMesh& result) {
    std::string all;
    for (const std::string& text : evaluate(result, truth, few()).warnings) all += text;
    return all;
  };
  EXPECT_EQ(warnings(test::sphere({1.3, 2, 3}, 1.2, 4)), "");
  EXPECT_THAT(warnings(test::sphere({1, 2, 3}, 1000, 4)), HasSubstr("1000 times as large"));
  EXPECT_THAT(warnings(test::sphere({1, 2, 3}, 0.2, 4)), HasSubstr("0.2 times as large"));
  EXPECT_THAT(warnings(test::sphere({1, 4, 3}, 1, 4)), HasSubstr("lies elsewhere"));
  // A part of the truth, and debris far away.
  TriMesh part = test::sphere({1, 2, 3}, 1, 4);
  std::erase_if(part.triangles, [&](const auto& t) { return part.positions[t[0]].x < 0; });
  EXPECT_EQ(warnings(part), "");
  EXPECT_EQ(
      warnings(test::together(test::sphere({1, 2, 3}, 1, 4), test::sphere({50, 2, 3}, 0.05, 1))),
      "");
}

TEST(Evaluate, AGrownSphereIsOutsideByItsGrowth) {
  const Truth truth(test::sphere({1, 2, 3}, 1, 6));
  const Evaluation grown = evaluate(test::sphere({1, 2, 3}, 1.05, 6), truth, few());
  EXPECT_NEAR(grown.all.accuracy, 0.05, 3e-4);  // facets are that far below the sphere
  EXPECT_NEAR(grown.all.mean_signed.value(), 0.05, 3e-4);
  EXPECT_NEAR(grown.volume.iou, 1 / std::pow(1.05, 3), 2e-3);
  const Evaluation shrunk = evaluate(test::sphere({1, 2, 3}, 0.95, 6), truth, few());
  EXPECT_NEAR(shrunk.all.mean_signed.value(), -0.05, 3e-4);
}

TEST(Evaluate, HalfASphereIsHalfComplete) {
  const TriMesh whole = test::sphere({0, 0, 0}, 1, 6);
  TriMesh half = whole;
  std::erase_if(half.triangles, [&](const auto& t) {
    return whole.positions[t[0]].z + whole.positions[t[1]].z + whole.positions[t[2]].z < 0;
  });
  const Evaluation e = evaluate(half, Truth(whole), few());
  EXPECT_NEAR(e.all.scores[0].recall, 0.5, 0.005);
  EXPECT_EQ(e.all.scores[0].precision, 1);
  EXPECT_NEAR(e.all.scores[0].f, 2 * 0.5 / 1.5, 0.005);
  EXPECT_THAT(e.volume.reason, HasSubstr("the result is not closed"));
}

TEST(Evaluate, NormalsOfATurnedPlane) {
  const double angle = 0.35;  // 20.05 degrees
  TriMesh turned = plate(0, 0, 0, 1, 4);
  for (glm::vec3& p : turned.positions)
    p = {float(p.x * std::cos(angle)), p.y, float(p.x * std::sin(angle))};
  const Truth truth(plate(-10, -10, 0, 20, 2));
  const Evaluation e = evaluate(turned, truth, few());
  EXPECT_NEAR(e.all.normals->mean, angle * 180 / 3.14159265358979, 1e-4);
  EXPECT_NEAR(e.all.normals->median, angle * 180 / 3.14159265358979, 1e-4);
  EXPECT_EQ(e.all.normals->within_10, 0);
  const Evaluation flipped = evaluate(test::turned_inside_out(plate(0, 0, 0, 1, 4)), truth, few());
  EXPECT_NEAR(flipped.all.normals->mean, 180, 1e-4);
}

/// Samples of a plate 100 x 100 at z = 0, of which cameras see those with x < 50.
Truth half_seen_plate() {
  std::vector<glm::dvec3> samples;
  std::vector<std::uint8_t> views;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      samples.emplace_back(x + 0.5, y + 0.5, 0);
      views.push_back(x < 25 ? 3 : x < 50 ? 1 : 0);
    }
  return Truth(plate(0, 0, 0, 100, 5), samples, views);
}

TEST(Evaluate, OnlySeenSurfaceCountsInSeen) {
  // Exact where cameras look, 1 off where none does: near unseen surface, so not counted.
  const TriMesh result = test::together(plate(0, 0, 0, 50, 3), plate(50, 0, 1, 50, 3));
  const Truth truth = half_seen_plate();
  const Evaluation e = evaluate(result, truth, few());
  EXPECT_EQ(e.truth_samples_seen, 5000u);
  EXPECT_NEAR(e.seen.share, 0.5, 0.001);
  EXPECT_NEAR(e.seen.accuracy, 0, 1e-6);
  EXPECT_NEAR(e.all.accuracy, 1, 1e-6);
  EXPECT_EQ(e.seen.scores[0].precision, 1);
  EXPECT_NEAR(e.all.scores[0].precision, 0.5, 0.001);
  EXPECT_NEAR(e.all.scores[0].recall, 0.5, 0.001);  // of the seen half, y < 50 is there
  // What floats farther than 5 % of the diagonal (7.07) over unseen surface counts again.
  const auto share_at = [&](double height) {
    return evaluate(test::together(plate(0, 0, 0, 50, 3), plate(50, 0, height, 50, 3)), truth,
                    few())
        .seen.share;
  };
  EXPECT_NEAR(share_at(7.0), 0.5, 0.001);
  EXPECT_EQ(share_at(7.1), 1);
  EvaluateOptions strict = few();
  strict.min_views = 2;
  EXPECT_EQ(evaluate(result, truth, strict).truth_samples_seen, 2500u);
  EXPECT_NEAR(evaluate(result, truth, strict).seen.share, 0.25, 0.001);
  strict.min_views = 4;
  EXPECT_THROW(evaluate(result, truth, strict), Error);
}

TEST(Evaluate, NothingSeenCountsEverythingAndSaysSo) {
  const Evaluation e = evaluate(plate(60, 0, 1, 30, 3), half_seen_plate(), few());
  EXPECT_EQ(e.seen.share, 0);
  EXPECT_NEAR(e.seen.accuracy, 1, 1e-6);
  ASSERT_EQ(e.warnings.size(), 1u);
  EXPECT_THAT(e.warnings[0], HasSubstr("no camera sees"));
}

TEST(Evaluate, PointsAreThinnedAndMeasured) {
  TriMesh cloud = plate(0, 0, 0.5, 100, 200);
  cloud.triangles.clear();
  cloud.positions.insert(cloud.positions.end(), 1000, glm::vec3(0, 0, 20));  // one cell
  const Evaluation e = evaluate(cloud, Truth(plate(0, 0, 0, 100, 5)), few());
  EXPECT_TRUE(e.points);
  EXPECT_EQ(e.result_samples, 201u * 201u + 1);
  EXPECT_NEAR(e.all.accuracy, 0.5, 1e-6);
  EXPECT_FALSE(e.all.normals.has_value());
  EXPECT_GT(e.to_result.mean, 0.5);  // to the nearest point, not to a surface
  EXPECT_LT(e.to_result.max, std::hypot(0.5, 0.36));
  EXPECT_THAT(e.volume.reason, HasSubstr("no faces"));
}

TEST(Evaluate, InwardFacesAreWarnedOf) {
  const TriMesh mesh = test::sphere({0, 0, 0}, 1, 3);
  const Evaluation e = evaluate(test::turned_inside_out(mesh), Truth(mesh), few());
  ASSERT_EQ(e.warnings.size(), 1u);
  EXPECT_THAT(e.warnings[0], HasSubstr("look inwards"));
}

TEST(Evaluate, TheSameWithAnyNumberOfThreads) {
  const TriMesh mesh = test::sphere({0.02, 0, 0}, 1, 5);
  const auto json_with = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return to_json(evaluate(mesh, Truth(test::sphere({0, 0, 0}, 1, 5)), few(50000)));
  };
  const std::string one = json_with(1);
  EXPECT_EQ(one, json_with(4));
  EXPECT_EQ(one, json_with(3));
}

TEST(Evaluate, JsonHasItsKeys) {
  EvaluateOptions options = few();
  options.absolute = {0.5};
  const auto j = nlohmann::json::parse(
      to_json(evaluate(plate(0, 0, 0.1, 100, 4), half_seen_plate(), options)));
  EXPECT_NEAR(j["accuracy"], 0.1, 1e-6);
  EXPECT_NEAR(j["accuracy_pct_diag"], 10 / (100 * std::sqrt(2)), 1e-6);
  EXPECT_EQ(j["seen"]["f"].size(), 4u);
  EXPECT_EQ(j["seen"]["f"][0]["t"], 0.001);
  EXPECT_EQ(j["seen"]["f"][3]["precision"], 1);
  EXPECT_EQ(j["f_absolute"][0]["t_world"], 0.5);
  EXPECT_NEAR(j["recon_to_gt"]["rms"], 0.1, 1e-6);
  EXPECT_TRUE(j["volume"]["iou"].is_null());
  EXPECT_THAT(j["volume"]["reason"].get<std::string>(), HasSubstr("not closed"));
  EXPECT_TRUE(j["visibility"]);
}

std::string error_of(const TriMesh& result, const EvaluateOptions& options) {
  try {
    evaluate(result, half_seen_plate(), options);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Evaluate, BadInputIsNamed) {
  const TriMesh good = plate(0, 0, 0, 100, 4);
  EXPECT_THAT(error_of(TriMesh(), few()), HasSubstr("no vertices"));
  TriMesh nan = good;
  nan.positions[3].y = NAN;
  EXPECT_THAT(error_of(nan, few()), HasSubstr("vertex 3"));
  const auto with = [](auto change) {
    EvaluateOptions options = few();
    change(options);
    return options;
  };
  EXPECT_THAT(error_of(good, with([](auto& o) {
                         o.thresholds = {0.1, 0};
                       })),
              HasSubstr("thresholds"));
  EXPECT_THAT(error_of(good, with([](auto& o) { o.thresholds = {1.5}; })), HasSubstr("thresholds"));
  EXPECT_THAT(error_of(good, with([](auto& o) { o.thresholds = {NAN}; })), HasSubstr("thresholds"));
  EXPECT_THAT(error_of(good, with([](auto& o) { o.thresholds = {}; })), HasSubstr("thresholds"));
  EXPECT_THAT(error_of(good, with([](auto& o) { o.absolute = {-1}; })), HasSubstr("absolute"));
  EXPECT_THAT(error_of(good, with([](auto& o) { o.samples = 10; })), HasSubstr("samples"));
  EXPECT_THAT(error_of(good, with([](auto& o) { o.min_views = 0; })), HasSubstr("min_views"));
}

TEST(DistanceStats, QuantilesAreTheInvertedDistribution) {
  const std::vector<double> values = {5, 1, 4, 2, 3};
  EXPECT_EQ(quantile(values, 0.2), 1);
  EXPECT_EQ(quantile(values, 0.21), 2);
  EXPECT_EQ(quantile(values, 0.5), 3);
  EXPECT_EQ(quantile(values, 0.9), 5);
  EXPECT_EQ(quantile(values, 0), 1);
  EXPECT_EQ(quantile(values, 1), 5);
  const DistanceStats s = distance_stats({3, 1, 2, 4});
  EXPECT_EQ(s.mean, 2.5);
  EXPECT_EQ(s.median, 2);
  EXPECT_EQ(s.rms, std::sqrt(7.5));
  EXPECT_EQ(s.q95, 4);
  EXPECT_EQ(s.max, 4);
}

}  // namespace
}  // namespace photohull::eval
