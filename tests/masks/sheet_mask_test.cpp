// Masks of objects on a printed sheet, as files have them.
#include "masks/sheet_mask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "masks/photographed_mask.h"
#include "support/pictures.h"

namespace photohull {
namespace {

constexpr int kPlantWidth = 960, kPlantHeight = 720;

/// Share of the paper's light that the page sends, as blurred as photographs are.
double print_at(double x, double y) {
  const auto beside = [](double d) { return std::clamp(0.5 + d / 1, 0.0, 1.0); };  // 3 pixels wide
  const double square = std::max(std::abs(x - 400), std::abs(y - 300)) - 40;
  return std::min(beside(x - 60), beside(square));
}

bool is_stem(double x, double left) { return x >= left && x < left + 4; }

/// A plant before the page: a leaf over a printed square, and two pairs of stems that meet above
/// and below: four pixels apart, and fifteen.
bool is_plant(double x, double y) {
  const bool leaf = std::hypot((x - 400) / 110, (y - 300) / 90) < 1;
  const bool near = (is_stem(x, 600) || is_stem(x, 608)) && y >= 150 && y < 500;
  const bool apart = (is_stem(x, 700) || is_stem(x, 719)) && y >= 150 && y < 500;
  const bool ends = ((x >= 600 && x < 612) || (x >= 700 && x < 723)) &&
                    ((y >= 140 && y < 150) || (y >= 500 && y < 510));
  return leaf || near || apart || ends;
}

/// All photographs agree on the paper, but for what is around the stems that are farther apart.
SheetLook look_of_page() {
  SheetLook look;
  look.width = kPlantWidth, look.height = kPlantHeight;
  for (int y = 0; y < kPlantHeight; ++y)
    for (int x = 0; x < kPlantWidth; ++x) {
      look.light.push_back(float(print_at(x, y)));
      look.possible.push_back(x > 200 && x < 850 && y > 60 && y < 660 ? 255 : 0);
      look.agreed.push_back(x > 690 && x < 735 && y > 130 && y < 520 ? 0 : 255);
    }
  look.paper.assign(look.light.size(), glm::vec3(0.9f));
  return look;
}

/// What is_there(x, y) says is there, of that light, before the page.
template <typename IsThere>
ColourImage photograph_of(const IsThere& is_there, const glm::vec3& object) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0, 0.004f);
  return paint_srgb(kPlantWidth, kPlantHeight, [&](double x, double y) {
    int inside = 0;  // of four places in the pixel
    for (const double u : {-0.25, 0.25})
      for (const double v : {-0.25, 0.25}) inside += is_there(x + u + 0.3, y + v + 0.3);
    const glm::vec3 page(float(0.81 * (0.05 + 0.95 * print_at(x + 0.2, y - 0.2))));
    glm::vec3 root = glm::sqrt(glm::mix(page, object, float(inside) / 4));
    for (int c = 0; c < 3; ++c) root[c] = std::max(0.0f, root[c] + noise(random));
    return root * root;
  });
}

ColourImage photograph_of_plant() { return photograph_of(is_plant, {0.25f, 0.36f, 0.20f}); }

/// Room for the object in a square of 12 pixels to every side of it.
template <typename IsThere>
std::vector<std::uint8_t> room_for(const IsThere& is_there) {
  constexpr int kRoom = 12;
  std::vector<std::uint8_t> hull(std::size_t(kPlantWidth) * kPlantHeight, 0);
  for (int y = kRoom; y < kPlantHeight - kRoom; ++y)
    for (int x = kRoom; x < kPlantWidth - kRoom; ++x) {
      if (!is_there(x, y)) continue;
      for (int v = -kRoom; v <= kRoom; ++v)
        std::fill_n(hull.begin() + (y + v) * kPlantWidth + x - kRoom, 2 * kRoom + 1,
                    std::uint8_t(255));
    }
  return hull;
}

class SheetMaskOfPlant : public testing::Test {
 protected:
  /// Pixels of the rectangle, [x0, x1) by [y0, y1), that the mask has as the object's.
  static int inside(int x0, int x1, int y0, int y1) {
    static const Mask mask = mask_from_sheet(photograph_of_plant(), look_of_page()).mask;
    int count = 0;
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) count += mask.coverage[std::size_t(y * kPlantWidth + x)] >= 128;
    return count;
  }
};

TEST_F(SheetMaskOfPlant, IsThere) {
  EXPECT_EQ(inside(601, 603, 160, 490), 2 * 330);
  EXPECT_EQ(inside(720, 722, 160, 490), 2 * 330);
}

TEST_F(SheetMaskOfPlant, GapsOverBarePaperStayOpen) { EXPECT_EQ(inside(605, 607, 160, 490), 0); }

TEST_F(SheetMaskOfPlant, ThinPartsDoNotMakeTheRestDoubtful) {
  EXPECT_EQ(inside(708, 715, 170, 480), 0);
}

TEST_F(SheetMaskOfPlant, PrintCutsNothing) { EXPECT_EQ(inside(340, 460, 250, 350), 120 * 100); }

TEST_F(SheetMaskOfPlant, NothingIsElsewhere) {
  EXPECT_EQ(inside(0, 280, 0, kPlantHeight) + inside(740, kPlantWidth, 0, kPlantHeight), 0);
}

/// A ball that hides the printed square, and ten pixels of paper around it.
bool is_ball(double x, double y) { return std::hypot(x - 400, y - 300) < 50; }

TEST(SheetMaskOfBall, WhatLooksLikePaperIsItsOwnWhereAllMasksHaveIt) {
  const ColourImage image = photograph_of(is_ball, glm::vec3(0.81f));
  SheetLook look = look_of_page();
  const auto covered = [&](const SheetLook& l) {
    const Mask mask = mask_from_sheet(image, l).mask;
    std::array<int, 2> count{};  // of the ball, and beside it
    for (int y = 0; y < kPlantHeight; ++y)
      for (int x = 0; x < kPlantWidth; ++x)
        count[is_ball(x, y) ? 0 : 1] += mask.coverage[std::size_t(y * kPlantWidth + x)] >= 128;
    return count;
  };
  const int ball = int(std::numbers::pi * 50 * 50);
  EXPECT_LT(covered(look)[0], 0.85 * ball);  // before the print alone
  look.hull = room_for(is_ball);
  EXPECT_GT(covered(look)[0], 0.99 * ball);
  // What looks like the ball beside it is as much its own, as far as there is room.
  EXPECT_LT(covered(look)[1], std::ranges::count(look.hull, 255) - ball + 100);
}

TEST(SheetMaskOfBall, RoomAloneChangesNothingOfWhatDiffersFromPaper) {
  SheetLook look = look_of_page();
  const ColourImage image = photograph_of_plant();
  const Mask before = mask_from_sheet(image, look).mask;
  look.hull = room_for(is_plant);
  const Mask after = mask_from_sheet(image, look).mask;
  int changed = 0;
  for (std::size_t i = 0; i < before.coverage.size(); ++i)
    changed += (before.coverage[i] >= 128) != (after.coverage[i] >= 128);
  EXPECT_LE(changed, 10);
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
