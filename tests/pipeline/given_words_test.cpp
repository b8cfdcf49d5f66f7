// The options that were given, as words for a shell.
#include "pipeline/given_words.h"

#include <gtest/gtest.h>

namespace photohull::pipeline {
namespace {

TEST(GivenWords, NoneAreAtTheirDefaults) { EXPECT_EQ(given_words({}, {}), ""); }

TEST(GivenWords, TellWhatWasGiven) {
  ReconstructOptions options;
  io::LoadSceneOptions load;
  Described described;
  describe(described, options, load);
  for (const auto& [name, text] : {std::pair{"resolution", "64"},
                                   {"method", "hull"},
                                   {"keep_views", "true"},
                                   {"box", "0 0 0 1 1 2"},
                                   {"masks", "it's mine"},
                                   {"export", "stl"},
                                   {"report_page", "off"}})
    read_option(*described.find(name), text);
  const std::string words = given_words(options, load) + " ";
  // A library's words; the command line has flags in their places.
  for (const char* word :
       {" resolution=64 ", " method=hull ", " keep_views ", " box='0 0 0 1 1 2' ",
        " masks='it'\\''s mine' ", " export=stl ", " report_page=off "})
    EXPECT_NE(words.find(word), std::string::npos) << word << " in " << words;
  EXPECT_EQ(words.find("quality"), std::string::npos);
}

TEST(GivenWords, RepeatListsOfTexts) {
  ReconstructOptions options;
  options.tune = {"vote.band=2", "a=b c"};
  EXPECT_EQ(given_words(options, {}), " tune=vote.band=2 tune='a=b c'");
}

}  // namespace
}  // namespace photohull::pipeline
