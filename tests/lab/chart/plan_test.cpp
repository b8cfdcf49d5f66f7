#include "lab/chart/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fake_program.h"

namespace photohull::chart {
namespace {

using test::error_of;
using test::FakeWorld;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(ReadPlan, GivesScenesVariantsAndDefaults) {
  const FakeWorld world({"ball", "cube"});
  world.plan(R"({"scenes": ["ball", {"path": "cube/", "name": "box"}], "methods": ["hull"],
                 "resolutions": [128, 64, 64], "arguments": ["--threads", "1"],
                 "variants": [{"name": "no masks", "arguments": ["--x"], "resolutions": []}]})");
  const Plan plan = read_plan(world / "plan.json");
  EXPECT_EQ(plan.title, "plan");
  EXPECT_EQ(plan.repeats, 1);
  EXPECT_FALSE(plan.keep);
  ASSERT_EQ(plan.scenes.size(), 2u);
  EXPECT_EQ(plan.scenes[0].path, world / "ball");
  EXPECT_EQ(plan.scenes[1].name, "box");
  ASSERT_EQ(plan.variants.size(), 2u);
  EXPECT_THAT(plan.variants[0].arguments, ElementsAre("--threads", "1", "--method", "hull"));
  EXPECT_THAT(plan.variants[0].resolutions, ElementsAre(64, 128));
  EXPECT_THAT(plan.variants[1].arguments, ElementsAre("--threads", "1", "--x"));
  EXPECT_THAT(plan.variants[1].resolutions, IsEmpty());
}

TEST(ReadPlan, TakesAFolderOfSpecs) {
  const FakeWorld world;
  std::filesystem::create_directory(world / "specs");
  write_text(world / "specs/b.json", "{}");
  write_text(world / "specs/a.json", "{}");
  write_text(world / "specs/README.md", "");
  world.plan(R"({"scenes": [{"specs": "specs"}, "specs/../ball"], "methods": ["hull"]})");
  const Plan plan = read_plan(world / "plan.json");
  ASSERT_EQ(plan.scenes.size(), 3u);
  EXPECT_EQ(plan.scenes[0].name, "a");
  EXPECT_TRUE(plan.scenes[0].synthetic);
  EXPECT_EQ(plan.scenes[1].name, "b");
  EXPECT_FALSE(plan.scenes[2].synthetic);
}

TEST(ReadPlan, LeavesOutOptionalScenesAndSaysSo) {
  const FakeWorld world;
  world.plan(R"({"methods": ["hull"], "scenes": ["ball", {"path": "nowhere", "optional": true},
                 {"optional": true, "scenes": ["gone", "spec.json"]},
                 {"specs": "no_specs", "optional": true}],
                 "external": [{"path": "peers.csv", "optional": true}]})");
  const Plan plan = read_plan(world / "plan.json");
  EXPECT_EQ(plan.scenes.size(), 1u);
  EXPECT_THAT(plan.external, IsEmpty());
  EXPECT_THAT(plan.notes,
              ElementsAre(HasSubstr("nowhere"), HasSubstr("gone"), HasSubstr("spec.json"),
                          HasSubstr("no_specs"), HasSubstr("peers.csv")));
}

struct BadPlan {
  const char* name;
  const char* json;
  std::vector<std::string> expected;  ///< parts of the message
};

class BadPlans : public testing::TestWithParam<BadPlan> {};

TEST_P(BadPlans, AreRefusedWithThePlaceAndTheMend) {
  const FakeWorld world;
  std::filesystem::create_directory(world / "bare");
  world.plan(GetParam().json);
  const std::string message = error_of([&] { read_plan(world / "plan.json"); });
  EXPECT_THAT(message, HasSubstr((world / "plan.json").string()));
  for (const std::string& part : GetParam().expected) EXPECT_THAT(message, HasSubstr(part));
}

INSTANTIATE_TEST_SUITE_P(
    Faults, BadPlans,
    testing::Values(
        BadPlan{"NotJson", "{\"scenes\": [\n\"ball\" \"cube\"]}", {"line 2"}},
        BadPlan{"NoObject", "[]", {"expected an object"}},
        BadPlan{"UnknownField",
                R"({"scenes": ["ball"], "method": ["hull"]})",
                {"method: unknown field", "did you mean 'methods'"}},
        BadPlan{"UnknownSceneField",
                R"({"scenes": ["ball", {"path": "ball", "optinal": true}], "methods": ["hull"]})",
                {"scenes[1].optinal", "did you mean 'optional'"}},
        BadPlan{"FarFromAllNames",
                R"({"scenes": ["ball"], "zzzzzzzzzzzz": 1})",
                {"zzzzzzzzzzzz: unknown field; expected one of title, scenes"}},
        BadPlan{"MissingScene",
                R"({"scenes": ["ball", "nowhere"], "methods": ["hull"]})",
                {"scenes[1]", "nowhere", "optional"}},
        BadPlan{"MissingNestedScene",
                R"({"scenes": [{"scenes": ["ball", "nowhere"]}], "methods": ["hull"]})",
                {"scenes[0].scenes[1]", "nowhere"}},
        BadPlan{"SceneWithoutTruth",
                R"({"scenes": ["bare"], "methods": ["hull"]})",
                {"scenes[0]", "gt.ply"}},
        BadPlan{"WrongType",
                R"({"scenes": "ball", "methods": ["hull"]})",
                {"scenes: expected an array, found \"ball\""}},
        BadPlan{"WrongElementType",
                R"({"scenes": ["ball"], "methods": ["hull"], "resolutions": [64, "128"]})",
                {"resolutions[1]", "expected a whole number from 1", "found \"128\""}},
        BadPlan{"OutOfRange",
                R"({"scenes": ["ball"], "methods": ["hull"], "resolutions": [0]})",
                {"resolutions[0]", "found 0"}},
        BadPlan{"FractionalRepeats",
                R"({"scenes": ["ball"], "methods": ["hull"], "repeats": 1.5})",
                {"repeats", "found 1.5"}},
        BadPlan{"NoMethods", R"({"scenes": ["ball"]})", {"the plan has no runs"}},
        BadPlan{"NoScenes", R"({"methods": ["hull"]})", {"the plan has no runs"}},
        BadPlan{"AllScenesAbsent",
                R"({"methods": ["hull"], "scenes": [{"path": "x", "optional": true}]})",
                {"all its scenes are absent"}},
        BadPlan{"EqualScenes",
                R"({"scenes": ["ball", "ball"], "methods": ["hull"]})",
                {"scenes[1]", "'ball' is taken already"}},
        BadPlan{"EqualVariants",
                R"({"scenes": ["ball"], "methods": ["hull"], "variants": [{"name": "hull"}]})",
                {"variants[0].name", "'hull' is taken already"}},
        BadPlan{"OwnArgument",
                R"({"scenes": ["ball"], "variants": [{"name": "a", "arguments": ["--out", "x"]}]})",
                {"--out is set by the chart"}},
        BadPlan{"NameThatIsNoFileName",
                R"({"scenes": [{"path": "ball", "name": "../x"}], "methods": ["hull"]})",
                {"scenes[0]", "'../x'"}},
        BadPlan{"NameThatIsATemplate",
                R"({"scenes": ["ball"], "variants": [{"name": "{a}"}]})",
                {"variants[0].name", "brace"}},
        BadPlan{"MissingExternal",
                R"({"scenes": ["ball"], "methods": ["hull"], "external": ["peers.csv"]})",
                {"external[0]", "peers.csv"}}),
    [](const auto& test) { return test.param.name; });

TEST(ReadPlan, NamesAFileThatIsNotThere) {
  EXPECT_THAT(error_of([] { read_plan("/nowhere/plan.json"); }), HasSubstr("/nowhere/plan.json"));
}

}  // namespace
}  // namespace photohull::chart
