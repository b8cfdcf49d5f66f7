#include "batch/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "batch/engine.h"
#include "core/error.h"

namespace photohull::batch {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

TEST(Plan, ComesBackAsItWas) {
  const Plan plan{"1-2",
                  "/data/night 3",
                  true,
                  16,
                  {{"0007", {"rig.json", "--images=frames/0007", "--tune=a=1"}, "7", "x"},
                   {"0008", {"it's \"one\"\n"}, "8", "y"}}};
  const Plan back = plan_from_json(to_json(plan), "/out/plan.json");
  EXPECT_EQ(back.id, plan.id);
  EXPECT_EQ(back.folder, plan.folder);
  EXPECT_TRUE(back.sequence);
  EXPECT_EQ(back.tiles, 16);
  ASSERT_EQ(back.pieces.size(), 2u);
  EXPECT_EQ(back.pieces[0].name, "0007");
  EXPECT_EQ(back.pieces[0].words, plan.pieces[0].words);
  EXPECT_EQ(back.pieces[1].words, plan.pieces[1].words);
  EXPECT_EQ(back.pieces[1].from, "/out/plan.json, piece 0008");
}

TEST(Plan, OtherTextsAreNone) {
  const std::string whole = to_json({"1", "/a", false, 0, {{"b", {"c"}, {}, {}}}});
  for (const std::string& text :
       {std::string(), std::string("[]"), std::string("{\"folder\": \"/a\"}"),
        whole.substr(0, whole.size() / 2), std::string(10000, '[')})
    try {
      plan_from_json(text, "/out/plan.json");
      ADD_FAILURE() << text.substr(0, 40);
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr("/out/plan.json"));
    }
  // A name that would leave the folder.
  EXPECT_THROW(plan_from_json(to_json({"1", "/a", false, 0, {{"../b", {"c"}, {}, {}}}}), "p"),
               Error);
}

TEST(Plan, IdsDiffer) { EXPECT_NE(new_plan_id(), new_plan_id()); }

TEST(Plan, PiecesAreCountedFromOne) {
  EXPECT_THAT(chosen_pieces("3", 5), ElementsAre(2u));
  EXPECT_THAT(chosen_pieces("3-5", 5), ElementsAre(2u, 3u, 4u));
  for (const char* text : {"0", "6", "4-6", "3-2", "", "a", "3-", "-3", "3 "})
    EXPECT_THROW(chosen_pieces(text, 5), UsageError) << text;
}

TEST(Engine, ScriptsStartWorkersAndOneMoreAtTheEnd) {
  for (const Engine engine : kEngines) {
    const std::string script =
        script_of({engine, "/opt/it's/photohull", "/data/night 3", 7, "--threads 2", "--extra x"});
    EXPECT_THAT(script, AllOf(HasSubstr("7"), HasSubstr("run"), HasSubstr("--threads 2"),
                              HasSubstr("merge"), EndsWith("\n")))
        << to_string(engine);
    if (engine != Engine::kLocal) {
      EXPECT_THAT(script, HasSubstr(" --extra x ")) << to_string(engine);
      EXPECT_THAT(script, HasSubstr(program_of(engine) + " ")) << to_string(engine);
    }
  }
}

}  // namespace
}  // namespace photohull::batch
