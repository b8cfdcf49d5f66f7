// The stress test's smoke plan through the program itself.
#include <nlohmann/json.hpp>

#include "sphere_scene.h"
#include "support/places.h"

namespace photohull::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class Stress : public SphereScene {
 protected:
  static std::string plan() { return test::in_checkout("bench/plans/stress_smoke.json"); }
  nlohmann::json results() const {
    return nlohmann::json::parse(read_bytes(path("stress/results.json")));
  }
};

TEST_F(Stress, TheSmokePlanGivesCurvesMarksAndReports) {
  const Finished dry = succeed({"stress", plan(), "--out", path("stress"), "--dry-run"});
  EXPECT_THAT(dry.out, HasSubstr("5 of 5 runs to do"));
  const Finished made =
      succeed({"stress", plan(), "--out", path("stress"), "--axes", "mask-dilated"});
  EXPECT_THAT(made.out, AllOf(HasSubstr("3 runs made"), HasSubstr("1 px of mask error")));
  const nlohmann::json r = results();
  ASSERT_EQ(r["curves"].size(), 1u);
  ASSERT_EQ(r["samples"].size(), 3u);
  for (const auto& sample : r["samples"]) {
    EXPECT_EQ(sample["report"]["scene"]["views"], 16);
    EXPECT_TRUE(sample["confidence"].is_number());
  }
  EXPECT_GT(r["samples"][0]["f05"], 0.5);
  EXPECT_LT(r["curves"][0]["points"][2]["kept05"], 0.5) << "masks 8 pixels too large";
  EXPECT_TRUE(r["curves"][0]["breakdown_f05"].is_number());
  for (const char* file : {"index.html", "summary.md", "stress--silhouettes.png"})
    EXPECT_TRUE(std::filesystem::exists(path(std::string("stress/") + file))) << file;
  const Finished again = succeed({"stress", plan(), "--out", path("stress"), "--axes", "repeats"});
  EXPECT_THAT(again.out, HasSubstr("1 runs made, 1 there already"));
  EXPECT_EQ(results()["curves"][0]["points"][1]["other_mesh"], 0);
}

TEST_F(Stress, WrongUsagePlansAndSpecsAreNamed) {
  fail(2, {"stress", plan()}, {"--out"});
  fail(2, {"stress", plan(), "--out", out(), "--axes", "nois"}, {"no axis 'nois'", "repeats"});
  fail(2, {"stress", plan(), "--out", out(), "--draw-only", "--force"}, {"--draw-only"});
  fail(1, {"stress", path("none.json"), "--out", out()}, {"none.json"});
  write_bytes(path("plan.json"), R"({"scenes": [{"name": "ball"}], "axes": [
      {"name": "noise", "fields": ["degradations.nois"], "strengths": [1]}]})");
  fail(1, {"stress", path("plan.json"), "--out", out()},
       {"plan.json", "ball: noise 1", "degradations.nois"});
}

}  // namespace
}  // namespace photohull::test
