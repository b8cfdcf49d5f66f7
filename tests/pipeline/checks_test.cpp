#include "pipeline/checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/option_word.h"
#include "core/too_many_voxels.h"
#include "support/ray_cast.h"

namespace photohull::pipeline {
namespace {

using testing::HasSubstr;

const Box kBox{glm::dvec3(-0.5), glm::dvec3(0.5)};

/// Eight cameras around the box, so far from it.
std::vector<SourceView> around(double distance) {
  std::vector<SourceView> views(8);
  for (int i = 0; i < 8; ++i)
    views[std::size_t(i)].camera =
        test::look_at({distance * std::cos(0.8 * i), distance * std::sin(0.8 * i), 0.3}, {0, 0, 0},
                      300, 200, 200);
  return views;
}

/// What is said of a job of so many MiB that may take 1 GiB; empty: it may be done.
std::string refusal(std::int64_t mebibytes) {
  try {
    check_memory({mebibytes << 20, 0, 1}, std::int64_t(1) << 30);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(CheckMemory, NamesBothSizesSuchThatTheyDiffer) {
  EXPECT_EQ(refusal(1024), "");
  EXPECT_THAT(refusal(3072), HasSubstr("about 3 GiB of memory, but may take 1 GiB"));
  EXPECT_THAT(refusal(1034), HasSubstr("about 1034 MiB of memory, but may take 1024 MiB"));
}

TEST(CheckMemory, TellsHowMuchOfTheSurfaceWouldFit) {
  const auto room = [](std::int64_t fixed) {
    try {
      check_memory({1000, fixed, 0.25}, 700);
    } catch (const TooManyVoxels& problem) {
      EXPECT_EQ(problem.voxel_size(), 0.25);
      return problem.room();
    }
    return double(NAN);
  };
  EXPECT_DOUBLE_EQ(room(0), 0.7);
  EXPECT_DOUBLE_EQ(room(400), 0.5);
  EXPECT_DOUBLE_EQ(room(700), 0);
  EXPECT_LT(room(900), 0) << "photographs alone do not fit";
}

TEST(HopelessSetup, CamerasAroundTheBoxAreFine) {
  EXPECT_EQ(hopeless_setup(kBox, "bbox.txt", around(3)), std::nullopt);
  EXPECT_EQ(hopeless_setup(kBox, "bbox.txt", around(60)), std::nullopt);   // seven pixels
  EXPECT_EQ(hopeless_setup(kBox, "bbox.txt", around(0.4)), std::nullopt);  // from within
}

TEST(HopelessSetup, OtherUnitsAreNamedWithBothLengths) {
  const auto why = hopeless_setup(kBox, "bbox.txt", around(3000));
  ASSERT_TRUE(why);
  EXPECT_THAT(*why, HasSubstr("the box from bbox.txt is 1.7 across, the cameras stand 3000 away"));
  EXPECT_THAT(*why, HasSubstr("covers 0.17 pixels of any photograph at most"));
  EXPECT_THAT(*why, HasSubstr("millimetres and metres"));
}

TEST(HopelessSetup, ABoxThatWasGivenIsToBeMadeLarger) {
  const Box tiny{glm::dvec3(0), glm::dvec3(1e-3)};
  const auto why = hopeless_setup(tiny, option_word("box"), around(3));
  ASSERT_TRUE(why);
  EXPECT_THAT(*why, HasSubstr("make box larger"));
}

TEST(HopelessSetup, CamerasInOnePlaceShowNoDepth) {
  std::vector<SourceView> views = around(3);
  for (SourceView& view : views) view.camera = views.front().camera;
  const auto why = hopeless_setup(kBox, "bbox.txt", views);
  ASSERT_TRUE(why);
  EXPECT_THAT(*why, HasSubstr("all 8 cameras stand in one place"));
}

}  // namespace
}  // namespace photohull::pipeline
