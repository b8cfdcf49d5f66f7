#include "lab/chart/stress_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fake_program.h"

namespace photohull::chart {
namespace {

using test::error_of;
using test::FakeWorld;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(ReadStressPlan, GivesScenesVariantsAxesAndTheirSpecs) {
  const FakeWorld world;
  write_text(world / "cup.json", R"({"geometry": {"mesh": "cup.ply"}, "image": {"width": 640}})");
  world.plan(
      R"({"spec": {"image": {"width": 64}}, "seeds": [3, 1, 3], "arguments": ["--method", "hull"],
    "scenes": [{"name": "cup", "path": "cup.json", "spec": {"image": {"height": 48}}},
               {"name": "rare", "spec": {}, "on_demand": true}],
    "variants": [{"name": "plain"}, {"name": "carved", "arguments": ["--method", "space-carving"]}],
    "axes": [
      {"name": "noise", "fields": ["degradations.read_noise"], "strengths": [0.1, 0.5],
       "spec": {"light": {"shadows": false}}, "marks": [{"text": "little noise", "at": 0.1}]},
      {"name": "views", "fields": ["cameras.count"], "clean": 60, "strengths": [20, 5], "log": true,
       "scenes": ["rare"], "variants": ["carved"]},
      {"name": "voxels", "argument": "--resolution", "clean": 64, "strengths": [128]},
      {"name": "kind", "points": [{"label": "grey", "spec": {"background": {"colour": [1, 1, 1]}}},
                                  {"label": "none", "arguments": ["--masks", "none"]}]}]})");
  const StressPlan plan = read_stress_plan(world / "plan.json");
  EXPECT_THAT(plan.seeds, ElementsAre(1, 3));
  ASSERT_EQ(plan.scenes.size(), 2u);
  EXPECT_THAT(plan.variants[1].arguments, ElementsAre("--method", "space-carving"));
  ASSERT_EQ(plan.axes.size(), 4u);

  const StressAxis& noise = plan.axes[0];
  EXPECT_THAT(noise.scenes, ElementsAre(0));
  EXPECT_THAT(noise.variants, ElementsAre(0, 1));
  const Json spec = stress_spec(plan.scenes[0], noise.points[1], 7);
  EXPECT_EQ(spec["geometry"]["mesh"], (world / "cup.ply").string());
  EXPECT_EQ(spec["image"], (Json{{"width", 64}, {"height", 48}}));
  EXPECT_EQ(spec["degradations"]["read_noise"], 0.5);
  EXPECT_EQ(spec["light"]["shadows"], false);
  EXPECT_EQ(spec["seed"], 7);
  EXPECT_FALSE(stress_spec(plan.scenes[0], noise.clean, 7).contains("degradations"));
  ASSERT_EQ(noise.marks.size(), 1u);
  EXPECT_EQ(noise.marks[0].point, 0u);
  EXPECT_EQ(noise.marks[0].variant, "plain");

  EXPECT_EQ(plan.axes[1].clean.spec["cameras"]["count"], 60);
  EXPECT_EQ(plan.axes[1].points[1].strength, 5);
  EXPECT_THAT(plan.axes[1].scenes, ElementsAre(1));
  EXPECT_THAT(plan.axes[2].points[0].arguments, ElementsAre("--resolution", "128"));
  EXPECT_TRUE(plan.axes[3].kinds);
  EXPECT_EQ(plan.axes[3].points[1].label, "none");
}

TEST(ReadStressPlan, ASelectionNamesAxesAndSeeds) {
  const FakeWorld world;
  world.plan(R"({"scenes": [{"name": "a"}], "axes": [
    {"name": "x", "fields": ["seed"], "strengths": [1]},
    {"name": "y", "fields": ["seed"], "strengths": [1]}]})");
  const StressPlan plan = read_stress_plan(world / "plan.json", {{"y"}, {4, 5}});
  ASSERT_EQ(plan.axes.size(), 1u);
  EXPECT_EQ(plan.axes[0].name, "y");
  EXPECT_THAT(plan.seeds, ElementsAre(4, 5));
  EXPECT_THAT(error_of([&] {
                read_stress_plan(world / "plan.json", {{"z"}, {}});
              }),
              testing::AllOf(HasSubstr("no axis 'z'"), HasSubstr("x, y")));
}

TEST(MergeArguments, LaterOnesReplaceEarlierOnesOfTheSameName) {
  EXPECT_THAT(
      merge_arguments({"--resolution", "80", "--tune", "a=1"},
                      {"--masks", "none", "--resolution", "40", "--tune", "b=2"}),
      ElementsAre("--resolution", "40", "--tune", "a=1", "--masks", "none", "--tune", "b=2"));
}

TEST(StressPlan, TooManyLevelsAreRefused) {
  constexpr int kLevels = 300000;  // more than the stack has room for
  const FakeWorld world;
  world.plan("{\"title\": " + std::string(kLevels, '[') + std::string(kLevels, ']') + "}");
  EXPECT_THAT(error_of([&] { read_stress_plan(world / "plan.json"); }), HasSubstr("levels"));
  std::string field = "a";
  for (int i = 0; i < kLevels; ++i) field += ".a";
  world.plan(R"({"scenes": [{"name": "a"}],
                 "axes": [{"name": "x", "strengths": [1], "fields": [")" +
             field + "\"]}]}");
  EXPECT_THAT(error_of([&] { read_stress_plan(world / "plan.json"); }),
              HasSubstr("axes[0].fields: more than 64 levels"));
}

struct BadPlan {
  const char* name;
  const char* axes;  ///< of a plan with the scenes a and b and the variant v
  std::vector<std::string> expected;
};

class BadStressPlans : public testing::TestWithParam<BadPlan> {};

TEST_P(BadStressPlans, AreRefusedWithThePlaceAndTheMend) {
  const FakeWorld world;
  world.plan(concat(R"({"scenes": [{"name": "a"}, {"name": "b"}], "variants": [{"name": "v"}],
                        "axes": [)",
                    GetParam().axes, "]}"));
  const std::string message = error_of([&] { read_stress_plan(world / "plan.json"); });
  EXPECT_THAT(message, HasSubstr((world / "plan.json").string()));
  for (const std::string& part : GetParam().expected) EXPECT_THAT(message, HasSubstr(part));
}

INSTANTIATE_TEST_SUITE_P(
    Faults, BadStressPlans,
    testing::Values(
        BadPlan{"NoAxes", "", {"axes", "no runs"}},
        BadPlan{"UnknownField",
                R"({"name": "x", "field": "a", "strengths": [1]})",
                {"axes[0].field: unknown field", "did you mean 'fields'"}},
        BadPlan{"NothingToSet", R"({"name": "x", "strengths": [1]})", {"axes[0].fields", "to set"}},
        BadPlan{"NoPoints", R"({"name": "x", "fields": ["s"]})", {"axes[0].points", "either"}},
        BadPlan{"EmptyPoints", R"({"name": "x", "points": []})", {"axes[0].points", "none"}},
        BadPlan{"TurnsBack",
                R"({"name": "x", "fields": ["s"], "strengths": [1, 3, 2]})",
                {"axes[0].strengths", "lead away", "2 does not"}},
        BadPlan{"CleanAmongThem",
                R"({"name": "x", "fields": ["s"], "clean": 2, "strengths": [1, 2, 3]})",
                {"lead away from the clean one (2)"}},
        BadPlan{"Twice",
                R"({"name": "x", "points": [{"label": "k"}, {"label": "k"}]})",
                {"'k' is there twice"}},
        BadPlan{"NumberedAndNot",
                R"({"name": "x", "points": [{"label": "k"}, {"strength": 2}]})",
                {"axes[0].points", "either all"}},
        BadPlan{"NoLabel",
                R"({"name": "x", "points": [{"spec": {}}]})",
                {"axes[0].points[0].label: is missing"}},
        BadPlan{"UnknownScene",
                R"({"name": "x", "fields": ["s"], "strengths": [1], "scenes": ["c"]})",
                {"axes[0].scenes", "no 'c'"}},
        BadPlan{"UnknownVariant",
                R"({"name": "x", "fields": ["s"], "strengths": [1], "variants": ["w"]})",
                {"axes[0].variants", "no 'w'"}},
        BadPlan{"MarkThatIsNowhere",
                R"({"name": "x", "fields": ["s"], "strengths": [1],
                    "marks": [{"text": "t", "at": 2}]})",
                {"axes[0].marks[0].at", "no '2'"}},
        BadPlan{"OwnArgument",
                R"({"name": "x", "points": [{"label": "k", "arguments": ["--out", "y"]}]})",
                {"--out is set by"}},
        BadPlan{"NoLogarithm",
                R"({"name": "x", "fields": ["s"], "strengths": [-1], "log": true})",
                {"axes[0].log"}},
        BadPlan{"EqualNames",
                R"({"name": "x", "fields": ["s"], "strengths": [1]},
                   {"name": "x", "fields": ["s"], "strengths": [1]})",
                {"axes[1].name", "taken already"}}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace photohull::chart
