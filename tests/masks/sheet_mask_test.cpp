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

}  // namespace
}  // namespace photohull
