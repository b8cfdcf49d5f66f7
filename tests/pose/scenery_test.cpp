// What photographs on a sheet tell of where the object can be.
#include <gtest/gtest.h>

#include "pose/pose_scenery.h"
#include "pose/pose_turntable.h"

namespace photohull::pose {
namespace {

constexpr int kWidth = 8, kHeight = 2;
/// Of a shadow half as large as the picture, which has the second of its four columns alone.
const std::vector<std::uint8_t> kHull{0, 0, 255, 255, 0, 0, 0, 0, 0, 0, 255, 255, 0, 0, 0, 0};

Mask shadow() { return {4, 1, {0, 255, 0, 0}}; }

/// A picture of nothing but bare page, or of nothing of it.
SheetLook look(float light) {
  SheetLook out;
  out.width = kWidth, out.height = kHeight;
  out.light.assign(kHull.size(), light);
  out.possible.assign(kHull.size(), 255);
  return out;
}

TEST(SheetScenery, BesideThePageTheObjectIsInItsShadowAlone) {
  const SheetScenery scenery{{}, {shadow()}};
  SheetLook beside = look(-1);
  scenery.narrow(0, beside);
  EXPECT_EQ(beside.possible, kHull);
  EXPECT_EQ(beside.hull, kHull);
}

TEST(SheetScenery, OnThePageItsHullIsNoted) {
  const SheetScenery scenery{{}, {shadow()}};
  SheetLook page = look(1);
  page.possible[0] = 0;  // bare page is seen
  const std::vector<std::uint8_t> possible = page.possible;
  scenery.narrow(0, page);
  EXPECT_EQ(page.possible, possible);
  EXPECT_EQ(page.hull, kHull);
}

TEST(SheetScenery, WhatMayCoverTheSheetIsNoObjectBesideItsShadow) {
  const SheetScenery scenery{{}, {shadow()}, {{4, 1, {255, 255, 0, 0}}}};
  SheetLook page = look(1);
  page.possible[15] = 0;  // bare page is seen
  std::vector<std::uint8_t> possible = page.possible;
  scenery.narrow(0, page);
  EXPECT_EQ(page.possible, possible) << "no light is known";

  page.agreed.assign(kHull.size(), 255);
  std::vector<std::uint8_t> agreed = page.agreed;
  for (const std::size_t i : {0, 1, 8, 9}) possible[i] = agreed[i] = 0;
  scenery.narrow(0, page);
  EXPECT_EQ(page.possible, possible);
  EXPECT_EQ(page.agreed, agreed);
}

TEST(SheetScenery, WithoutShadowsNothingIsKnown) {
  SheetLook page = look(1);
  SheetScenery{}.narrow(0, page);
  SheetScenery{{}, {Mask{}}}.narrow(0, page);
  TurntableFinding{}.note_hull(0, page);
  EXPECT_TRUE(page.hull.empty());
}

TEST(TurntableFinding, NotesTheHullOfItsShadows) {
  TurntableFinding finding;
  finding.shadows = {shadow()};
  SheetLook page = look(1);
  finding.note_hull(0, page);
  EXPECT_EQ(page.hull, kHull);
}

}  // namespace
}  // namespace photohull::pose
