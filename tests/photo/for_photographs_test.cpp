#include "photo/for_photographs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

namespace photohull {
namespace {

TEST(ForPhotographs, EachIsWorkedOnOnceAndCounted) {
  std::vector<std::atomic<int>> worked(1000);
  std::vector<std::size_t> done;
  for_photographs(
      1000, 1e6, [&](std::size_t i) { ++worked[i]; }, [&](std::size_t n) { done.push_back(n); });
  for (const std::atomic<int>& times : worked) EXPECT_EQ(times, 1);
  std::vector<std::size_t> counted(1000);
  std::iota(counted.begin(), counted.end(), std::size_t(1));
  EXPECT_EQ(done, counted);
  for_photographs(0, 1e6, [](std::size_t) { FAIL(); });
}

TEST(ForPhotographs, HoldsNoMoreThanSixtyFourMillionPixels) {
  for (const auto& [pixels, most] : {std::pair(24e6, 2), std::pair(64e6, 1), std::pair(1e9, 1)}) {
    std::atomic<int> held = 0;
    for_photographs(64, pixels, [&, allowed = most](std::size_t) {
      EXPECT_LE(++held, allowed);
      --held;
    });
  }
}

TEST(ForPhotographs, ThrowsWhatTheFirstOfThemThrows) {
  for (int round = 0; round < 20; ++round) {
    std::size_t counted = 0;
    try {
      for_photographs(
          200, 1e5,
          [](std::size_t i) {
            if (i == 40 || i == 41 || i >= 150) throw std::runtime_error(std::to_string(i));
          },
          [&](std::size_t) { ++counted; });
      FAIL();
    } catch (const std::runtime_error& failure) {
      EXPECT_STREQ(failure.what(), "40");
    }
    EXPECT_GE(counted, 40u);
  }
}

}  // namespace
}  // namespace photohull
