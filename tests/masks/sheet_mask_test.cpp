// Masks of objects on a printed sheet, as files have them.
#include "masks/sheet_mask.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "masks/photographed_mask.h"
#include "support/pictures.h"

namespace photohull {
namespace {

constexpr int kPlantWidth = 160, kPlantHeight = 120;

bool is_ink(double x, double y) { return x < 20 || (x > 60 && x < 80 && y > 40 && y < 60); }

/// A plant before the page: two stems, seven pixels apart, that meet above and below, and a leaf
/// over a printed square.
bool is_plant(double x, double y) {
  const bool stems = y > 20 && y < 100 && ((x > 100 && x < 104) || (x > 111 && x < 115));
  const bool ends = x > 100 && x < 115 && ((y > 16 && y < 21) || (y > 99 && y < 104));
  const bool leaf = std::hypot((x - 70) / 22, (y - 50) / 16) < 1;
  return stems || ends || leaf;
}

SheetLook look_of_page() {
  SheetLook look;
  look.width = kPlantWidth, look.height = kPlantHeight;
  for (int y = 0; y < kPlantHeight; ++y)
    for (int x = 0; x < kPlantWidth; ++x) {
      look.light.push_back(is_ink(x, y) ? 0.0f : 1.0f);
      look.possible.push_back(x > 30 && x < 150 && y > 8 && y < 112 ? 255 : 0);
    }
  look.paper.assign(look.light.size(), glm::vec3(0.9f));
  look.agreed.assign(look.light.size(), 255);
  return look;
}

ColourImage photograph_of_plant() {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 0.004f);
  return paint_srgb(kPlantWidth, kPlantHeight, [&](double x, double y) {
    glm::vec3 root = is_plant(x, y) ? glm::vec3(0.35f, 0.6f, 0.3f)
                     : is_ink(x + 0.3, y - 0.3)
                         ? glm::vec3(0.2f)  // print is not quite where it should be
                         : glm::vec3(0.9f);
    for (int c = 0; c < 3; ++c) root[c] = std::max(0.0f, root[c] + noise(random));
    return root * root;
  });
}

TEST(SheetMask, GapsOverBarePaperStayOpenAndPrintCutsNothing) {
  const Mask mask = mask_from_sheet(photograph_of_plant(), look_of_page(), true).mask;
  ASSERT_FALSE(mask.empty());
  int lacking = 0, closed = 0, elsewhere = 0;
  for (int y = 0; y < kPlantHeight; ++y)
    for (int x = 0; x < kPlantWidth; ++x) {
      const bool inside = mask.coverage[std::size_t(y * kPlantWidth + x)] >= 128;
      const bool well_within =
          is_plant(x - 1, y) && is_plant(x + 1, y) && is_plant(x, y - 1) && is_plant(x, y + 1);
      lacking += well_within && !inside;
      closed += inside && x >= 106 && x <= 109 && y > 30 && y < 90;
      elsewhere += inside && (x < 40 || x > 125);
    }
  EXPECT_EQ(lacking, 0);
  EXPECT_EQ(closed, 0);
  EXPECT_EQ(elsewhere, 0);
}

TEST(KeepPartsIn, WhatIsNowhereInTheShadowGoes) {
  Mask mask{8, 2, {255, 255, 0, 200, 0, 255, 255, 255, 0, 0, 0, 0, 0, 0, 0, 100}};
  const Mask before = mask;
  keep_parts_in({}, mask);
  EXPECT_EQ(mask.coverage, before.coverage);
  keep_parts_in({4, 1, {255, 0, 0, 255}}, mask);  // half as large
  EXPECT_EQ(mask.coverage, (std::vector<std::uint8_t>{255, 255, 0, 0, 0, 255, 255, 255, 0, 0, 0, 0,
                                                      0, 0, 0, 100}));
}

TEST(PhotographedMask, StripsBesideThePhotographGoButWhereTheObjectGoesOn) {
  constexpr int kSide = 300;
  ColourImage image = paint_srgb(kSide, kSide, [](double, double) { return glm::vec3(0.5f); });
  Mask mask{kSide, kSide, std::vector<std::uint8_t>(kSide * kSide, 0)};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const std::size_t i = std::size_t(y * kSide + x);
      if (y < 3) image.bytes[4 * i + 3] = 0, mask.coverage[i] = 255;
      if (x > 20 && x < 30 && y < 50) mask.coverage[i] = 255;
    }
  EXPECT_EQ(photographed_mask(image, mask).coverage,
            mask.coverage);  // no alpha: all is photographed
  image.has_alpha = true;
  const Mask found = photographed_mask(image, mask);
  EXPECT_EQ(found.coverage[25], 255);
  EXPECT_EQ(found.coverage[70], 255);
  EXPECT_EQ(found.coverage[200], 0);
  EXPECT_EQ(found.coverage[std::size_t(40 * kSide + 25)], 255);
}

TEST(KeepShares, EvidenceBesideTheObjectGoesAndPartialPixelsStay) {
  Mask mask{6, 3, {0, 0, 0, 0, 0, 0, 90, 255, 128, 60, 60, 127, 0, 0, 0, 0, 0, 127}};
  keep_shares(mask);
  EXPECT_EQ(mask.coverage, (std::vector<std::uint8_t>{0, 0, 0, 0, 0, 0, 90, 255, 128, 60, 0, 0, 0,
                                                      0, 0, 0, 0, 0}));
}

TEST(KeepShares, SpecksGoAndSmallPartsStay) {
  constexpr int kSide = 100;
  const auto at = [](int x, int y) { return std::size_t(y * kSide + x); };
  Mask mask{kSide, kSide, std::vector<std::uint8_t>(kSide * kSide, 0)};
  for (int y = 10; y < 80; ++y)
    for (int x = 10; x < 80; ++x) mask.coverage[at(x, y)] = 255;
  mask.coverage[at(90, 5)] = mask.coverage[at(91, 6)] = 255;     // two of 4900 pixels
  for (int x = 85; x < 88; ++x) mask.coverage[at(x, 50)] = 200;  // three
  keep_shares(mask);
  EXPECT_EQ(mask.coverage[at(90, 5)], 0);
  EXPECT_EQ(mask.coverage[at(91, 6)], 0);
  EXPECT_EQ(mask.coverage[at(86, 50)], 200);
  EXPECT_EQ(mask.coverage[at(10, 10)], 255);
}

}  // namespace
}  // namespace photohull
