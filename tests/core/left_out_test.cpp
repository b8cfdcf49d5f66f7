#include "core/left_out.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"

namespace photohull {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using Reason = LeftOutView::Reason;

Scene scene_of(int views) {
  Scene scene;
  for (int i = 0; i < views; ++i) {
    scene.views.emplace_back();
    scene.views.back().name = concat("v", i);
  }
  return scene;
}

std::vector<LeftOutView> unusable(int count, Reason reason = Reason::kMissing) {
  std::vector<LeftOutView> list;
  for (int i = 0; i < count; ++i) list.push_back({concat("x", i), "file line 7", reason, "detail"});
  return list;
}

std::string error_of(Scene scene, const std::vector<LeftOutView>& list, bool strict = false) {
  try {
    note_left_out(scene, list, strict);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(KeepViews, TracksFollowTheirViews) {
  Scene scene = scene_of(4);
  scene.tracks = {{{{0, {1, 1}}, {1, {2, 2}}, {3, {3, 3}}}}, {{{0, {4, 4}}, {1, {5, 5}}}}};
  keep_views(scene, {true, false, true, true});
  ASSERT_EQ(scene.views.size(), 3u);
  EXPECT_EQ(scene.views[2].name, "v3");
  ASSERT_EQ(scene.tracks.size(), 1u);  // the other is left with one observation
  ASSERT_EQ(scene.tracks[0].observations.size(), 2u);
  EXPECT_EQ(scene.tracks[0].observations[0].view, 0);
  EXPECT_EQ(scene.tracks[0].observations[1].view, 2);
  EXPECT_EQ(scene.tracks[0].observations[1].pixel, glm::dvec2(3, 3));
}

TEST(NoteLeftOut, CountsAndNames) {
  Scene scene = scene_of(10);
  EXPECT_THAT(note_left_out(scene, unusable(5), false),
              ElementsAre(AllOf(HasSubstr("5 of 15 photographs were not found and are left out"),
                                HasSubstr("(x0, x1, x2 and 2 more; detail)"))));
  EXPECT_EQ(scene.left_out.size(), 5u);
  scene = scene_of(10);
  auto list = unusable(1);
  list.push_back({"torn", "torn.jpg", Reason::kUnreadable, "cut short"});
  list.push_back({"wide", "file line 9", Reason::kSize, "it is wide"});
  EXPECT_THAT(
      note_left_out(scene, list, false),
      ElementsAre(HasSubstr("1 of 13 photographs was not found and is left out (x0; detail"),
                  HasSubstr("1 of 13 photographs cannot be read and is left out (torn: cut"),
                  HasSubstr("does not have its camera's shape and is left out (wide: it")));
  EXPECT_TRUE(note_left_out(scene, {}, true).empty());
}

TEST(NoteLeftOut, TwoOfThreeAndThreeMustRemain) {
  EXPECT_EQ(error_of(scene_of(20), unusable(10)), "no error");
  EXPECT_THAT(error_of(scene_of(19), unusable(10)),
              AllOf(HasSubstr("file line 7: 10 of 29 photographs were not found"),
                    HasSubstr("and 7 more; detail"), HasSubstr("at least two of three")));
  EXPECT_EQ(error_of(scene_of(3), unusable(1)), "no error");
  EXPECT_THAT(error_of(scene_of(2), unusable(1)), HasSubstr("three views, must remain"));
  EXPECT_THAT(error_of(scene_of(0), unusable(4)), HasSubstr("4 of 4"));
  EXPECT_THAT(error_of(scene_of(20), unusable(1), true), HasSubstr("strict asks for all"));
}

/// What was left out before counts, though the views were thinned out in between.
TEST(NoteLeftOut, SharesAddUp) {
  Scene scene = scene_of(80);
  note_left_out(scene, unusable(20), false);
  scene.views.resize(10);
  EXPECT_EQ(error_of(scene, unusable(2)), "no error");  // 0.8 * 10 / 12 = 0.6667
  EXPECT_THAT(error_of(scene, unusable(3)), HasSubstr("3 of 13"));
}

}  // namespace
}  // namespace photohull
