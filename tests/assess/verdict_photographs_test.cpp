#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "verdict_signals.h"

namespace photohull::assess {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(Verdict, WithoutSilhouettesSaysWhatIsExplained) {
  const Verdict v = judged(without_silhouettes({{Place::kExplained, 90},
                                                {Place::kMissed, 4},
                                                {Place::kDisagreeing, 6},
                                                {Place::kBare, 100}}));
  EXPECT_EQ(v.level, Level::kGood);
  EXPECT_THAT(v.notes,
              ElementsAre(HasSubstr("explains 90 % of the texture"), HasSubstr("on 50 %")));
  EXPECT_THAT(v.notes[0], HasSubstr("on 6 % other views show something else"));
}

TEST(Verdict, WithoutSilhouettesWhatIsNotExplainedCounts) {
  expect(judged(without_silhouettes({{Place::kExplained, 60}, {Place::kMissed, 40}})),
         Level::kDoubtful, "on 40 % there is surface that the model lacks");
  expect(judged(without_silhouettes({{Place::kExplained, 60}, {Place::kDisagreeing, 40}})),
         Level::kDoubtful, "check the cameras");
  expect(judged(without_silhouettes({{Place::kExplained, 60}, {Place::kAlone, 40}})),
         Level::kDoubtful, "add views beside these");
  expect(judged(without_silhouettes({{Place::kExplained, 20}, {Place::kMissed, 80}})),
         Level::kFailed, "explains 20 %");
  expect(judged(without_silhouettes({{Place::kExplained, 20}, {Place::kAlone, 80}})),
         Level::kDoubtful, "explains 20 %");  // which need not be wrong
  expect(judged(without_silhouettes({{Place::kExplained, 70}, {Place::kCut, 30}})),
         Level::kDoubtful, "30 % of what the photographs show there stands just outside the box");
  EXPECT_EQ(judged(without_silhouettes({{Place::kExplained, 70}, {Place::kBeyond, 70}})).level,
            Level::kGood);
}

TEST(Verdict, AnEmptyModelOfTexturedPhotographsHasFailed) {
  const Verdict v = judged(without_silhouettes({{Place::kBare, 100}, {Place::kBeyond, 10}}));
  EXPECT_EQ(v.level, Level::kFailed);
  EXPECT_THAT(v.reasons, ElementsAre(HasSubstr("nearly empty"), HasSubstr("on 91 %")));
}

TEST(Verdict, PlainPhotographsSayThatTheyTellNothing) {
  expect(judged(without_silhouettes({{Place::kPlain, 100}, {Place::kExplained, 1}})),
         Level::kDoubtful, "99 % of the photographs' area in the box is plain");
}

TEST(Verdict, NamesTheViewsThatAreExplainedLeast) {
  Signals s = without_silhouettes({{Place::kExplained, 100}});
  for (PlaceAt& p : s.explained.views[7].places) p.place = Place::kMissed;
  s.explained.counts[std::size_t(Place::kExplained)] -= 100;
  s.explained.counts[std::size_t(Place::kMissed)] += 100;
  const Verdict v = judged(s);
  EXPECT_EQ(v.level, Level::kGood);
  EXPECT_THAT(v.notes, ElementsAre(HasSubstr("least in view7 (0 %)")));
}

TEST(Verdict, NamesPhotographsThatAreOfSomethingElse) {
  Signals s = without_silhouettes({{Place::kExplained, 100}});
  for (const int i : {3, 7})
    for (PlaceAt& p : s.explained.views[std::size_t(i)].places) p.place = Place::kDisagreeing;
  s.explained.counts[std::size_t(Place::kExplained)] -= 200;
  s.explained.counts[std::size_t(Place::kDisagreeing)] += 200;
  const Verdict v = judged(s);
  EXPECT_EQ(v.level, Level::kDoubtful);
  EXPECT_THAT(v.reasons, ElementsAre(HasSubstr("view3, view7: other views show something else")));
}

// So much may disagree because the surface is bad, and no photograph is to blame.
TEST(Verdict, NoPhotographIsBlamedWhereMuchDisagreesAnyway) {
  Signals s = without_silhouettes({{Place::kExplained, 60}, {Place::kDisagreeing, 40}});
  for (PlaceAt& p : s.explained.views[3].places) p.place = Place::kDisagreeing;
  for (const std::string& reason : judged(s).reasons)
    EXPECT_THAT(reason, Not(HasSubstr("upside down")));
}

TEST(Verdict, NamesPhotographsThatAreOfSomethingElseBesideRightMasks) {
  Signals s = without_silhouettes({{Place::kExplained, 100}});
  s.masks = true;
  s.compared.views = std::exchange(s.explained.views, {});
  s.explained.counts = {};
  for (PlaceAt& p : s.compared.views[3].places) p.place = Place::kDisagreeing;
  expect(judged(s), Level::kDoubtful, "view3: other views show something else");
}

TEST(Verdict, WithoutSilhouettesHolesInTheModelCount) {
  Signals s = without_silhouettes({{Place::kExplained, 90}, {Place::kBare, 10}});
  EXPECT_EQ(judged(s).level, Level::kGood);
  s.explained.on_surface = 1000, s.explained.behind = 100;
  expect(judged(s), Level::kDoubtful, "on 10 % of the model the photographs look at its inside");
  s.explained.behind = 0;
  s.cameras_within = 1;  // where bare texture cannot be background
  expect(judged(s), Level::kDoubtful, "on 10 % of what cameras inside the box see");
}

}  // namespace
}  // namespace photohull::assess
