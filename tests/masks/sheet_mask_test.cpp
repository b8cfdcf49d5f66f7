// Masks of objects on a printed sheet, as files have them.
#include "masks/sheet_mask.h"

#include <gtest/gtest.h>

namespace photohull {
namespace {

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
