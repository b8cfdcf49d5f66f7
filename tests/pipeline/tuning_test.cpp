#include "pipeline/tuning.h"

#include <gtest/gtest.h>

#include "core/error.h"

namespace photohull::pipeline {
namespace {

TEST(Tune, SetsFieldsOfEveryKind) {
  refine::RefineOptions r;
  SharpenOptions s;
  tune({"levels=2", "step=0.25", "voting=0", "match.best_pairs=1", "vote.band=2e0",
        "peak.least_score=-0.5", "sharpen=0", "sharpen.reach=7"},
       r, s);
  EXPECT_EQ(r.levels, 2);
  EXPECT_EQ(r.step, 0.25);
  EXPECT_FALSE(r.voting);
  EXPECT_EQ(r.match.best_pairs, 1);
  EXPECT_EQ(r.vote.band, 2);
  EXPECT_EQ(r.peak.least_score, -0.5);
  EXPECT_FALSE(s.on);
  EXPECT_EQ(s.reach, 7);
  carving::PhotoOptions p;
  tune({"max_rounds=1", "keep_score=0.9", "front_face=1", "max_rounds=3"}, p);
  EXPECT_EQ(p.max_rounds, 3) << "the last one counts";
  EXPECT_EQ(p.keep_score, 0.9);
  EXPECT_TRUE(p.front_face);
}

/// The message of the UsageError that an assignment meets.
std::string refusal(const std::string& text) {
  refine::RefineOptions options;
  SharpenOptions sharpen;
  try {
    tune({text}, options, sharpen);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Tune, NamesWhatIsWrong) {
  for (const char* text : {"keep_score=0.5", "=2", "", "Levels=2", "levels =2", "match=1"})
    EXPECT_NE(refusal(text).find("this method has no '"), std::string::npos) << text;
  EXPECT_NE(refusal("level=2").find("levels, look.least_lines"), std::string::npos);
  for (const char* text :
       {"levels", "levels=", "levels=two", "levels=2x", "step=nan", "step=inf", "step=1e300"})
    EXPECT_NE(refusal(text).find(std::string(text) + ": expected NAME=NUMBER"), std::string::npos)
        << text;
  for (const char* text : {"levels=2.5", "voting=2", "voting=-1", "voting=0.5"})
    EXPECT_NE(refusal(text).find("expected a whole number"), std::string::npos) << text;
}

}  // namespace
}  // namespace photohull::pipeline
