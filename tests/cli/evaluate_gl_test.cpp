// photohull evaluate as a user runs it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "child_process.h"
#include "support/scratch_folder.h"

namespace photohull::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A box [0, edge] x [0, 1] x [0, 1].
std::string box_obj(double edge) {
  std::string text;
  for (int i = 0; i < 8; ++i)
    text += "v " + std::to_string(i & 1 ? edge : 0.0) + (i & 2 ? " 1" : " 0") +
            (i & 4 ? " 1\n" : " 0\n");
  return text + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

class Evaluate : public testing::Test {
 protected:
  void SetUp() override {
    write_text(folder_ / "truth.obj", box_obj(1));
    write_text(folder_ / "result.obj", box_obj(1.25));
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  Finished evaluate(const Arguments& more, const std::string& mesh = "result.obj") const {
    Arguments arguments = {"evaluate",        path(mesh),  "--truth",
                           path("truth.obj"), "--samples", "5000"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_photohull(arguments);
  }
  void fail(int code, const Finished& run, const std::string& part) const {
    EXPECT_EQ(run.code, code) << run.err;
    EXPECT_THAT(run.err, HasSubstr(part));
    EXPECT_EQ(run.error_lines("photohull: ").size(), 1u) << run.err;
    EXPECT_EQ(run.out, "");
  }
  ScratchFolder folder_;
};

TEST_F(Evaluate, AnotherFrameIsToldAndAlignedOnDemand) {
  // Ten times as large, turned by a quarter about z, and away; its sides are unlike.
  std::string text, moved;
  const double sides[3] = {1, 2, 4};
  for (int i = 0; i < 8; ++i) {
    const double p[3] = {i & 1 ? sides[0] : 0, i & 2 ? sides[1] : 0, i & 4 ? sides[2] : 0};
    const auto line = [](double x, double y, double z) {
      return "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    };
    text += line(p[0], p[1], p[2]);
    moved += line(100 - 10 * p[1], 10 * p[0], 10 * p[2] - 7);
  }
  const std::string faces = box_obj(1).substr(box_obj(1).find("f "));
  write_text(folder_ / "truth.obj", text + faces);
  write_text(folder_ / "away.obj", moved + faces);
  const Finished away = evaluate({"--json"}, "away.obj");
  ASSERT_EQ(away.code, 0) << away.err;
  const json off = json::parse(away.out);
  EXPECT_EQ(off["f"][0]["f"], 0);
  EXPECT_FALSE(off.contains("alignment"));
  EXPECT_THAT(std::string(off["warnings"][0]), HasSubstr("--align"));
  const json j = json::parse(evaluate({"--json", "--align"}, "away.obj").out);
  EXPECT_EQ(j["f"][0]["f"], 1);
  EXPECT_EQ(j["warnings"], json::array());
  EXPECT_NEAR(j["alignment"]["scale"], 0.1, 1e-6);
  EXPECT_LT(j["alignment"]["rms"], 1e-5);
  EXPECT_EQ(j["alignment"]["rotation"].size(), 3u);
  EXPECT_THAT(evaluate({"--align"}, "away.obj").out,
              HasSubstr("aligned     scaled by 0.1, turned by"));
  fail(2, run_photohull({"evaluate", path("result.obj"), "--align", "--photos", "x"}), "--align");
}

TEST_F(Evaluate, PointsServeAsTruth) {
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2402\nproperty float x\nproperty float y\n"
      "property float z\nend_header\n";
  int count = 0;
  for (int i = 0; i <= 20; ++i)
    for (int j = 0; j <= 20; ++j)
      for (int k = 0; k <= 20; ++k)
        if (i % 20 == 0 || j % 20 == 0 || k % 20 == 0) {
          ply += std::to_string(i / 20.0) + " " + std::to_string(j / 20.0) + " " +
                 std::to_string(k / 20.0) + "\n";
          ++count;
        }
  ASSERT_EQ(count, 2402);
  write_text(folder_ / "scan.ply", ply);
  const Arguments by_scan = {"evaluate",       path("truth.obj"), "--truth",
                             path("scan.ply"), "--samples",       "5000"};
  const Finished text = run_photohull(by_scan);
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("the nearest of 2402 points, which are 0.05 apart"));
  EXPECT_THAT(text.out, HasSubstr("IoU not known: the truth has no faces"));
  Arguments as_json = by_scan;
  as_json.push_back("--json");
  const json j = json::parse(run_photohull(as_json).out);
  EXPECT_EQ(j["truth_mode"], "points");
  EXPECT_EQ(j["completeness"], 1);
  EXPECT_LT(j["accuracy"], 0.04);
  EXPECT_GT(j["accuracy"], 0.01);  // of places between the points
  Arguments picture = by_scan;
  picture.insert(picture.end(), {"--error-image", path("e.png")});
  fail(1, run_photohull(picture), "has no faces; --error-image");
}

TEST_F(Evaluate, TextAndJsonTellTheSame) {
  const Finished text = evaluate({});
  ASSERT_EQ(text.code, 0) << text.err;
  for (const char* part : {"8 vertices, 12 faces", "all surface counts", "accuracy (90 %)",
                           "completeness", "IoU 0.80"})
    EXPECT_THAT(text.out, HasSubstr(part));
  const Finished run = evaluate({"--json", "--thresholds", "0.01,0.2", "--absolute", "0.3"});
  ASSERT_EQ(run.code, 0) << run.err;
  const json j = json::parse(run.out);
  EXPECT_EQ(j["f"].size(), 2u);
  EXPECT_EQ(j["f"][1]["precision"], 1);
  EXPECT_EQ(j["f_absolute"][0]["precision"], 1);
  EXPECT_LT(j["f"][0]["precision"], 0.9);
  EXPECT_NEAR(j["recon_to_gt"]["max"], 0.25, 1e-6);
  EXPECT_NEAR(j["volume"]["iou"], 0.8, 0.005);
  EXPECT_FALSE(j["visibility"]);
}

TEST_F(Evaluate, WritesItsFilesTogether) {
  ASSERT_EQ(evaluate({"--error-mesh", path("e.ply"), "--error-image", path("e.png")}).code, 0);
  EXPECT_THAT(read_text(folder_ / "e.ply"), HasSubstr("property float distance"));
  EXPECT_EQ(read_text(folder_ / "e.png").substr(1, 3), "PNG");
  EXPECT_EQ(folder_.file_count(), 4u);
}

TEST_F(Evaluate, WrongUsageAndBadFiles) {
  fail(2, run_photohull({"evaluate", path("result.obj")}), "--truth");
  fail(2, evaluate({"--thresholds", "0.1,2"}), "--thresholds");
  fail(2, evaluate({"--thresholds", "a"}), "--thresholds");
  fail(2, evaluate({"--samples", "5"}), "--samples");
  fail(2, evaluate({"--error-range", "0"}), "--error-range");
  fail(1, evaluate({}, "missing.obj"), "missing.obj: it is no file");
  fail(1, evaluate({"--error-mesh", path("none/e.ply")}), "none");
  write_text(folder_ / "points.obj", "v 0 0 0\nv 1 1 1\n");
  fail(1, evaluate({"--error-image", path("e.png")}, "points.obj"), "points.obj");
  fail(1, run_photohull({"evaluate", path("result.obj"), "--truth", path("")}), "no gt.ply");
  EXPECT_EQ(folder_.file_count(), 3u);
}

/// Two points on the truth and one 0.5 beside it, with a confidence each, and one that nobody saw.
constexpr const char* kJudged =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    "property float z\nproperty float confidence\nend_header\n"
    "0 0 0 0.9\n1 0 0 0.7\n1.5 0.5 0.5 0.2\n0.5 0 0 0\n";

TEST_F(Evaluate, Reliability) {
  write_text(folder_ / "judged.ply", kJudged);
  const Finished text =
      evaluate({"--reliability", "0.1", "--reliability-plot", path("r.png")}, "judged.ply");
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, HasSubstr("3 vertices, 66.67 % within, and 1 that no camera saw"));
  EXPECT_THAT(text.out, HasSubstr("AUC 1.0000"));
  EXPECT_EQ(read_text(folder_ / "r.png").substr(1, 3), "PNG");
  const Finished run = evaluate(
      {"--json", "--reliability", "0.1", "--reliability-plot", path("r.svg")}, "judged.ply");
  ASSERT_EQ(run.code, 0) << run.err;
  const json j = json::parse(run.out)["reliability"];
  EXPECT_EQ(j["bins"].size(), 10u);
  EXPECT_EQ(j["bins"][8]["count"], 1);
  EXPECT_NEAR(j["calibration_error"], (0.1 + 0.3 + 0.2) / 3, 1e-6);
  EXPECT_NEAR(j["brier"], (0.01 + 0.09 + 0.04) / 3, 1e-6);
  EXPECT_NEAR(j["spearman"], -std::sqrt(0.75), 1e-6);
  EXPECT_THAT(read_text(folder_ / "r.svg"), HasSubstr("<svg"));
  EXPECT_FALSE(json::parse(evaluate({"--json"}, "judged.ply").out).contains("reliability"));
}

TEST_F(Evaluate, ReliabilityRefusesWhatItCannotJudge) {
  write_text(folder_ / "judged.ply", kJudged);
  fail(1, evaluate({"--reliability", "0.1"}), "no confidence");
  fail(2, evaluate({"--reliability", "0"}, "judged.ply"), "--reliability");
  fail(2, evaluate({"--reliability-plot", path("r.svg")}, "judged.ply"), "--reliability DISTANCE");
  fail(2, evaluate({"--reliability", "1", "--reliability-plot", path("r.jpg")}, "judged.ply"),
       ".svg or .png");
  fail(1, evaluate({"--reliability", "1", "--reliability-plot", path("none/r.svg")}, "judged.ply"),
       "none");
  EXPECT_EQ(folder_.file_count(), 3u);
}

}  // namespace
}  // namespace photohull::test
