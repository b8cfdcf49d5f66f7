#include "assess/verdict.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "verdict_signals.h"

namespace photohull::assess {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(Verdict, GoodHasNoReasons) {
  const Verdict v = judged(in_order());
  EXPECT_EQ(v.level, Level::kGood);
  EXPECT_THAT(v.reasons, IsEmpty());
}

TEST(Verdict, NamesTheViewsThatDisagree) {
  Signals s = in_order();
  s.match.views[12].pixels = 4.1, s.match.views[13].pixels = 3.2;
  s.match.views[14] = residual(9, 2);  // too few matches to accuse it
  const Verdict v = judged(s);
  expect(v, Level::kDoubtful, "view12, view13 disagree with the rest by up to 4.1 px");
}

TEST(Verdict, WhenAllViewsDisagreeNoneIsNamed) {
  Signals s = in_order();
  s.match.residual = 0.8;
  for (std::size_t i = 0; i < 20; ++i) s.match.views[i].pixels = i % 2 ? 0.1 : 1.5;
  expect(judged(s), Level::kDoubtful, "cameras disagree by 0.8 px");
  s.match.residual = 2.5;
  expect(judged(s), Level::kFailed, "cameras disagree by 2.5 px");
}

// A median of a handful of matches says nothing about the cameras.
TEST(Verdict, FewMatchesAccuseNoCameras) {
  Signals s = in_order();
  s.match.residual = 2.5;
  s.match.views.assign(20, residual(2.5, 1));
  EXPECT_EQ(judged(s).level, Level::kGood);
  s.match.views.assign(20, residual(2.5, 2));
  expect(judged(s), Level::kFailed, "cameras disagree by 2.5 px");
}

// The same pixels matter less where they are smaller.
TEST(Verdict, ResidualsCountByWhatTheyCoverOfTheObject) {
  Signals s = in_order();
  s.match.residual = 0.8;
  s.match.pixel_size = 0.002;
  EXPECT_EQ(judged(s).level, Level::kGood);
  s.match.views[12].pixels = 0.8;  // of a view from near
  s.match.views[12].pixel_size = 0.002;
  EXPECT_EQ(judged(s).level, Level::kGood);
  s.match.views[12].pixel_size = 0.01;
  expect(judged(s), Level::kDoubtful, "view12 disagree with the rest by up to 0.8 px");
}

TEST(Verdict, CamerasWithErrorsOfTheirOwnAreNotOffAlike) {
  // 0.65 of the motion is two fifths of its square.
  const Verdict found = with([](Signals& s) { s.cameras_moved = 6, s.cameras_moved_alike = 3.9; });
  ASSERT_FALSE(found.reasons.empty());
  EXPECT_THAT(found.reasons, Each(Not(HasSubstr("off alike"))));
}

TEST(Verdict, EveryFaultHasItsReason) {
  expect(with([](Signals& s) { s.cameras_moved = 3; }), Level::kDoubtful, "moved by 3 px");
  EXPECT_EQ(with([](Signals& s) { s.cameras_moved = 2; }).level, Level::kGood);
  expect(with([](Signals& s) { s.cameras_moved = 2, s.cameras_moved_alike = 1.9; }),
         Level::kDoubtful, "off by 1.9 px; all were off alike");
  expect(with([](Signals& s) { s.few_views = 0.6; }), Level::kDoubtful,
         "fewer than three views see 60 %");
  expect(with([](Signals& s) { s.match.matched = 0.4; }), Level::kDoubtful,
         "on 54 % of the surface");
  expect(with([](Signals& s) { s.match.beyond_far = 0.7; }), Level::kFailed, "two views put 70 %");
  expect(with([](Signals& s) { s.match.beyond_far = 0.3; }), Level::kDoubtful,
         "two views put 30 %");
  expect(with([](Signals& s) { s.contradiction = 0.1; }), Level::kDoubtful,
         "contradict each other");
  expect(with([](Signals& s) { s.missed = 0.2; }), Level::kDoubtful,
         "20 % of the silhouettes empty");
  expect(with([](Signals& s) { s.missed = 0.5; }), Level::kFailed, "50 % of the silhouettes empty");
  expect(with([](Signals& s) { s.excess = 0.2; }), Level::kDoubtful, "lies on background");
  expect(with([](Signals& s) { s.unseen = 0.6; }), Level::kDoubtful, "no view sees 60 %");
  expect(with([](Signals& s) { s.unsure = 0.5, s.match.matched = 0.67; }), Level::kDoubtful,
         "confidence is below one half");
  EXPECT_EQ(with([](Signals& s) { s.unsure = 0.9; }).level, Level::kGood);  // colours alone differ
  expect(with([](Signals& s) { s.at_box = 0.5; }), Level::kDoubtful, "lies on the box's sides");
}

TEST(Verdict, SeveralSignsAtOnceAreDoubtful) {
  const auto folded = [](Signals& s) {
    s.unsure = s.unseen + 0.18, s.match.matched = 0.69, s.match.textured = 0.8;
  };
  Signals s = in_order();
  folded(s);
  const Verdict both = judged(s);
  EXPECT_EQ(both.level, Level::kDoubtful);
  EXPECT_THAT(both.reasons.front(), HasSubstr("of the surface the photographs do not confirm it"));
  EXPECT_EQ(with([](Signals& x) { x.unsure = x.unseen + 0.18; }).level, Level::kGood);
  EXPECT_EQ(with([](Signals& x) { x.match.matched = 0.75; }).level, Level::kGood);
  s.match.matched = 0.72;  // colours alone differ
  EXPECT_EQ(judged(s).level, Level::kGood);
}

// Lumps where masks are too large have low confidence, while the rest's texture is found again.
TEST(Verdict, LowConfidenceCountsWhereViewsShowSomethingElse) {
  const auto lumps = [](double disagreeing) {
    return with([&](Signals& s) {
      s.unsure = 0.52, s.unseen = 0.26, s.match.matched = 0.73, s.match.textured = 0.6;
      s.compared.counts[std::size_t(Place::kDisagreeing)] = int(std::lround(400 * disagreeing));
      s.compared.counts[std::size_t(Place::kExplained)] = int(std::lround(400 * (1 - disagreeing)));
    });
  };
  expect(lumps(0.12), Level::kDoubtful, "lumps where masks are too large do this, too");
  EXPECT_EQ(lumps(0.06).level, Level::kGood);
  const Verdict weaker = with([](Signals& s) {
    s.unsure = 0.28, s.unseen = 0.02, s.match.matched = 0.73, s.match.textured = 0.6;
    s.compared.counts[std::size_t(Place::kDisagreeing)] = 12;
    s.compared.counts[std::size_t(Place::kExplained)] = 88;
  });
  expect(weaker, Level::kDoubtful, "of the surface the photographs do not confirm it");
  // A handful of places tells nothing.
  EXPECT_EQ(with([](Signals& s) {
              s.unsure = 0.52;
              s.compared.counts[std::size_t(Place::kDisagreeing)] = 5;
              s.compared.counts[std::size_t(Place::kExplained)] = 15;
            }).level,
            Level::kGood);
}

TEST(Verdict, StemsThatMasksOrVoxelsDoNotShow) {
  expect(with([](Signals& s) { s.stems = 0.6, s.stems_restored = 0.9; }), Level::kDoubtful,
         "90 % of the thin parts were put back from the photographs");
  expect(with([](Signals& s) { s.stems = 0.6, s.voxel_size = 3 * s.far, s.resolution = 40; }),
         Level::kDoubtful, "use resolution=120");
  EXPECT_EQ(with([](Signals& s) { s.stems = 0.1, s.voxel_size = 3 * s.far; }).level, Level::kGood);
}

TEST(Verdict, ASurfaceThatTouchesTheBoxIsNotCutOff) {
  EXPECT_EQ(with([](Signals& s) { s.at_box = 0.5, s.hull_beyond = 0; }).level, Level::kGood);
  EXPECT_EQ(with([](Signals& s) { s.at_box = 0.5, s.hull_beyond = 0.1; }).level, Level::kGood);
  EXPECT_EQ(with([](Signals& s) { s.at_box = 0.5, s.hull_beyond = 0.2; }).level, Level::kDoubtful);
  // What masks show beyond the box tells more than a coarse hull of a larger one.
  const Verdict v = with([](Signals& s) {
    s.at_box = 0.1, s.hull_beyond = 0, s.beyond_box = 0.01, s.beyond_views = 0.8;
  });
  EXPECT_THAT(v.reasons.front(), HasSubstr("1 % of what the masks show lies beyond the box"));
}

// An object that stands on a table is not worse where it is seen.
TEST(Verdict, CoverageIsAStatementOfItsOwn) {
  Signals s = in_order();
  EXPECT_EQ(judged(s).coverage, "98 % of the surface is seen, 95 % by three views or more");
  s.unseen = 0.38, s.few_views = 0.4;
  EXPECT_EQ(judged(s).level, Level::kGood);
  EXPECT_THAT(judged(s).coverage, HasSubstr("62 % of the surface is seen, 60 % by three views"));
  EXPECT_THAT(judged(s).coverage, HasSubstr("add views there"));
}

TEST(Verdict, ABoxThatCutsTheObjectOffIsTheFirstReason) {
  Signals s = in_order();
  s.beyond_box = 0.2;
  EXPECT_EQ(judged(s).level, Level::kGood);  // wanted so, perhaps: nothing is wrong in the box
  EXPECT_THAT(judged(s).notes, ElementsAre(HasSubstr("20 % of what the masks show lies beyond")));
  s.missed = 0.1, s.missed_width = 30, s.contradiction = 0.1;
  EXPECT_EQ(judged(s).level, Level::kDoubtful);
  EXPECT_THAT(judged(s).reasons.front(), HasSubstr("the box cuts the object off"));
  s.beyond_box = 0.002;
  EXPECT_THAT(judged(s).reasons.front(), Not(HasSubstr("box")));
  s.beyond_box = 0.02;  // specks of single masks
  EXPECT_THAT(judged(s).reasons.front(), Not(HasSubstr("box")));
  s.beyond_views = 0.8;  // a smaller piece that most views show, and silhouettes stay empty
  EXPECT_THAT(judged(s).reasons.front(), HasSubstr("the box cuts the object off"));
  s.missed = 0, s.at_box = 0.1;  // or the surface ends there
  EXPECT_THAT(judged(s).reasons.front(), HasSubstr("the box cuts the object off"));
}

TEST(Verdict, WhatOutlinesAskForInAllViewsIsNamed) {
  const auto asking = [](Signals& s) {
    s.common.tangents = 100, s.common.before = 0.6, s.common.after = 0.2;
    s.common.shift_sigma = 0.1, s.common.focal_sigma = 0.003;
  };
  EXPECT_EQ(with(asking).level, Level::kGood);
  expect(with([&](Signals& s) { asking(s), s.common.focal_factor = 0.909; }), Level::kDoubtful,
         "all focal lengths times 0.909: they are too long");
  expect(with([&](Signals& s) {
           asking(s), s.common.shift = {8, 0};
         }),
         Level::kDoubtful, "all masks moved by (-8, 0) px: masks are shifted");
  // Not where it mends little, nor where it is uncertain.
  EXPECT_EQ(with([&](Signals& s) {
              asking(s), s.common.shift = {8, 0}, s.common.after = 0.5;
            }).level,
            Level::kGood);
  EXPECT_EQ(with([&](Signals& s) {
              asking(s), s.common.shift = {8, 0}, s.common.shift_sigma = 2;
            }).level,
            Level::kGood);
}

TEST(Verdict, FewViewsComeBeforeWhatFollowsFromThem) {
  const Verdict v = with([](Signals& s) { s.few_views = 0.6, s.match.beyond_far = 0.3; });
  EXPECT_THAT(v.reasons, ElementsAre(HasSubstr("add views"), HasSubstr("two views put 30 %")));
}

TEST(Verdict, PointsThatCoarseVoxelsPutAsideAskForFinerOnes) {
  expect(with([](Signals& s) {
           s.match.beyond_far = 0.3, s.voxel_size = 3 * s.far, s.resolution = 40;
         }),
         Level::kDoubtful, "use resolution=120");
}

TEST(Verdict, PartsThinnerThanVoxelsNameTheResolutionThatShowsThem) {
  Signals s = in_order();
  s.pixel_size = 0.01, s.voxel_size = 0.03, s.resolution = 100;
  s.missed = 0.1, s.missed_width = 3;
  const Verdict v = judged(s);
  EXPECT_EQ(v.level, Level::kDoubtful);
  EXPECT_THAT(v.reasons.front(), HasSubstr("about 3 px wide"));
  EXPECT_THAT(v.reasons.front(), HasSubstr("resolution=200"));
  s.missed_width = 0.4;  // voxels below half a pixel would show nothing more
  EXPECT_THAT(judged(s).reasons.front(), HasSubstr("resolution=600"));
  s.missed_width = 30;
  expect(judged(s), Level::kDoubtful, "silhouettes empty");
  s.missed_width = 1, s.voxel_size = 0.005;
  expect(judged(s), Level::kDoubtful, "silhouettes empty");
}

TEST(Verdict, PlainSurfaceIsFineWhereSilhouettesShowIt) {
  Signals s = in_order();
  s.match.textured = 0.02, s.match.matched = 0;
  EXPECT_EQ(judged(s).level, Level::kGood);
  s.unseen = 0.1, s.mean_confidence = 0.86;  // of what is seen, 0.96
  EXPECT_EQ(judged(s).level, Level::kGood);
  s.mean_confidence = 0.8;
  expect(judged(s), Level::kDoubtful, "too little texture on 98 %");
  s = in_order();
  s.match.textured = 0.02, s.match.matched = 0;
  s.masks = false;
  expect(judged(s), Level::kDoubtful, "too little texture on 98 %");
}

TEST(Verdict, StemsNeedNoTexture) {
  Signals s = in_order();
  s.match.textured = 0.02, s.match.matched = 0, s.mean_confidence = 0.8;
  s.stems = 0.7;
  EXPECT_EQ(judged(s).level, Level::kGood);
  s.stems = 0.05;
  expect(judged(s), Level::kDoubtful, "too little texture on 93 %");
}

TEST(Verdict, SilhouettesDoNotCountWhereThereAreNone) {
  Signals s = in_order();
  s.masks = false;
  s.missed = s.excess = s.contradiction = 1;
  EXPECT_EQ(judged(s).level, Level::kGood);
}

/// A hull of an object that is concave in places.
Signals hull_in_order() {
  Signals s = in_order();
  s.hull = true;
  s.match.matched = 0.75, s.match.beyond_far = 0.05;
  return s;
}

TEST(Verdict, AGoodHullSaysWhatItIs) {
  const Verdict v = judged(hull_in_order());
  EXPECT_EQ(v.level, Level::kGood);
  EXPECT_THAT(v.reasons, IsEmpty());
  EXPECT_THAT(v.notes, ElementsAre(testing::AllOf(HasSubstr("outer bound"),
                                                  HasSubstr("confirm it on 71 %"))));
  EXPECT_THAT(judged(in_order()).notes, IsEmpty());
}

TEST(Verdict, PlainHullsAreJudgedBySilhouettesAlone) {
  Signals s = hull_in_order();
  s.match.textured = 0.02, s.match.matched = 0;
  EXPECT_EQ(judged(s).level, Level::kGood);
  EXPECT_THAT(judged(s).notes, ElementsAre(HasSubstr("too little texture to tell")));
  s.missed = 0.2;
  expect(judged(s), Level::kDoubtful, "20 % of the silhouettes empty");
}

TEST(Verdict, HullsThatPhotographsDoNotConfirmAreDoubtful) {
  Signals s = hull_in_order();
  s.match.matched = 0.3;
  expect(judged(s), Level::kDoubtful, "on 72 % of its texture the photographs do not confirm");
  s.match.matched = 0.95, s.match.beyond_far = 0.2;  // found elsewhere tells more than not found
  expect(judged(s), Level::kDoubtful, "on 24 % of its texture the photographs do not confirm");
}

// Noise spreads what is not found again, a concavity has it all in one place.
TEST(Verdict, HullsWithPatchesThatAreNotConfirmedAreDoubtful) {
  Signals s = hull_in_order();
  s.match.unconfirmed_patches = 0.15;
  EXPECT_EQ(judged(s).level, Level::kGood);
  s.match.unconfirmed_patches = 0.24;
  expect(judged(s), Level::kDoubtful, "do not confirm the hull");
}

TEST(Verdict, HullsOfFewViewsAreDoubtful) {
  Signals s = hull_in_order();
  s.few_views = 0.8;
  expect(judged(s), Level::kDoubtful, "fewer than three views see 80 % of the surface");
}

// Many views all around are not to blame when no two of them look from near each other.
TEST(Verdict, HullsWhoseViewsCannotBeComparedSaySo) {
  Signals s = hull_in_order();
  s.match.seen = 0, s.match.textured = 0, s.match.matched = 0;
  EXPECT_EQ(judged(s).level, Level::kGood);
  EXPECT_THAT(judged(s).notes, ElementsAre(HasSubstr("no two views are near enough")));
}

TEST(Verdict, HullsWithoutAnyMaskFail) {
  Signals s = hull_in_order();
  s.masks = false;
  expect(judged(s), Level::kFailed, "no view has a mask");
}

TEST(Verdict, TheWorstReasonDecides) {
  Signals s = in_order();
  s.match.beyond_far = 0.3, s.unseen = 0.9;
  const Verdict v = judged(s);
  EXPECT_EQ(v.level, Level::kFailed);
  EXPECT_THAT(v.reasons, ElementsAre(HasSubstr("no view sees 90 %"), HasSubstr("two views put")));
  EXPECT_STREQ(to_string(v.level), "failed");
}

}  // namespace
}  // namespace photohull::assess
