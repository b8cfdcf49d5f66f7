#include "pipeline/tuning.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <set>
#include <string>

#include "core/error.h"
#include "described_options.h"

namespace photohull::pipeline {
namespace {

TEST(Tune, SetsFieldsOfEveryKind) {
  Parameters p;
  tune({"levels=2", "step=0.25", "voting=0", "match.best_pairs=1", "vote.band=2e0",
        "peak.least_score=-0.5", "sharpen=0", "sharpen.reach=7", "missing.full_miss=3",
        "stems.least_views=4", "close.longest=1", "match.seen_cosine=0.1"},
       Method::kRefine, p);
  EXPECT_EQ(p.refine.levels, 2);
  EXPECT_EQ(p.refine.step, 0.25);
  EXPECT_FALSE(p.refine.voting);
  EXPECT_EQ(p.refine.match.best_pairs, 1);
  EXPECT_EQ(p.refine.vote.band, 2);
  EXPECT_EQ(p.refine.peak.least_score, -0.5);
  EXPECT_EQ(p.refine.close.longest, 1);
  EXPECT_EQ(p.refine.match.seen_cosine, 0.1);
  EXPECT_FALSE(p.sharpen.on);
  EXPECT_EQ(p.sharpen.reach, 7);
  EXPECT_EQ(p.missing.full_miss, 3);
  EXPECT_EQ(p.stems.least_views, 4);
  tune({"missing.full_miss=4", "stems.least_views=5"}, Method::kHull, p);
  EXPECT_EQ(p.missing.full_miss, 4);
  EXPECT_EQ(p.stems.least_views, 5);
  tune({"max_rounds=1", "keep_score=0.9", "front_face=1", "max_rounds=3"}, Method::kSpaceCarving,
       p);
  EXPECT_EQ(p.photo.max_rounds, 3) << "the last one counts";
  EXPECT_EQ(p.photo.keep_score, 0.9);
  EXPECT_TRUE(p.photo.front_face);
}

/// The message of the UsageError that an assignment meets.
std::string refusal(const std::string& text, Method method = Method::kRefine) {
  Parameters parameters;
  try {
    tune({text}, method, parameters);
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Tune, NamesWhatIsWrong) {
  for (const char* text : {"keep_score=0.5", "=2", "", "Levels=2", "levels =2", "match=1"})
    EXPECT_NE(refusal(text).find("this method has no '"), std::string::npos) << text;
  EXPECT_NE(refusal("level=2").find("levels, look.least_lines"), std::string::npos);
  EXPECT_NE(refusal("levels=2", Method::kHull).find("missing.full_miss"), std::string::npos);
  for (const char* text :
       {"levels", "levels=", "levels=two", "levels=2x", "step=nan", "step=inf", "step=1e300"})
    EXPECT_NE(refusal(text).find(std::string(text) + ": expected NAME=NUMBER"), std::string::npos)
        << text;
  for (const char* text : {"levels=2.5", "voting=2", "voting=-1", "voting=0.5"})
    EXPECT_NE(refusal(text).find("expected a whole number"), std::string::npos) << text;
}

TEST(Tune, LeavesToOptionsWhatIsTheirs) {
  for (const char* text : {"noise_sigma=0.02", "supersample=2", "search_radius=1"})
    EXPECT_NE(refusal(text, Method::kSpaceCarving).find("this is an option of its own: "),
              std::string::npos)
        << text;
}

TEST(Tune, RefusesWhatIsOutOfRange) {
  EXPECT_EQ(refusal("levels=9"), "levels must be 0 (automatic) to 8");
  EXPECT_EQ(refusal("restore.least_inside=-1"),
            "restore.least_inside must lie in [0, 1000] pixels");
  EXPECT_EQ(refusal("seat.reach=3"), "seat.reach must lie in [0, 3) voxels");
  EXPECT_EQ(refusal("vote.least_weight=0"), "vote.least_weight must be positive");
  EXPECT_EQ(refusal("close.belt=4"), "close.belt must not exceed close.rings");
  EXPECT_EQ(refusal("missing.full_miss=0"), "missing.full_miss must lie in [0.5, 100] pixels");
}

TEST(Tune, SetsEveryParameterOfEachMethod) {
  for (const Method method :
       {Method::kHull, Method::kVoxelColoring, Method::kSpaceCarving, Method::kRefine}) {
    Parameters usual;
    Described all;
    describe(all, method, usual);
    for (const Option& option : all.options()) {
      if (!option_that_sets(option.name).empty()) continue;
      Parameters parameters;
      tune({assignment_of(option)}, method, parameters);
      Described changed;
      describe(changed, method, parameters);
      for (const Option& other : changed.options())
        EXPECT_EQ(text_of(other) != text_of(*all.find(other.name)), other.name == option.name)
            << other.name << " by " << assignment_of(option);
    }
  }
}

struct Anything {
  template <typename T>
  constexpr operator T() const;
};

/// How many fields an aggregate has.
template <typename T, typename... Fields>
consteval std::size_t field_count() {
  if constexpr (requires { T{Fields{}..., Anything{}}; })
    return field_count<T, Fields..., Anything>();
  else
    return sizeof...(Fields);
}

/// Options, and groups of them, that are not within other groups.
template <typename T>
std::size_t described_count() {
  T options;
  Described all;
  describe(all, options);
  std::set<std::string> names;
  for (const Option& option : all.options())
    names.insert(option.name.substr(0, option.name.find('.')));
  return names.size();
}

template <typename T>
void expect_all_described(std::size_t others = 0) {
  EXPECT_EQ(described_count<T>() + others, field_count<T>());
}

TEST(Tune, ReachesEveryField) {
  expect_all_described<refine::RefineOptions>(1);  // bounded: no choice of a user
  expect_all_described<refine::VoteOptions>(1);    // nearest_partner: follows the views around
  expect_all_described<refine::OpenVoteOptions>();
  expect_all_described<refine::LabelOptions>();
  expect_all_described<refine::CloseOptions>();
  expect_all_described<refine::RestoreOptions>();
  expect_all_described<refine::HullPriorOptions>(2);
  expect_all_described<refine::ThinHullOptions>();
  expect_all_described<refine::UnprovenOptions>();
  expect_all_described<refine::MatchOptions>();
  expect_all_described<refine::LookOptions>();
  expect_all_described<refine::SeatOptions>();
  expect_all_described<refine::SettleOptions>();
  expect_all_described<refine::FitOptions>(1);  // first_voxel: follows the part
  expect_all_described<refine::PeakOptions>();
  expect_all_described<refine::RegularizeOptions>();
  expect_all_described<SharpenOptions>();
  expect_all_described<carving::MissingOptions>();
  expect_all_described<carving::StemOptions>();
  // method, statistic and visibility are flags of their own.
  expect_all_described<carving::PhotoOptions>(3);
}

}  // namespace
}  // namespace photohull::pipeline
