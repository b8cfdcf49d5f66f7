#include "photo/for_photographs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
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
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      --held;
    });
  }
}

// Whether that one or another throws first.
TEST(ForPhotographs, ThrowsWhatTheFirstOfThemThrows) {
  for (const std::size_t slow : {0, 1}) {
    std::atomic<int> worked = 0;
    try {
      for_photographs(2, 1e5, [&](std::size_t i) {
        ++worked;
        for (int waits = 0; worked < 2 && waits < 1000; ++waits)  // for another thread, if there is
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (i == slow) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        throw std::runtime_error(std::to_string(i));
      });
      FAIL();
    } catch (const std::runtime_error& failure) {
      EXPECT_STREQ(failure.what(), "0") << "slow: " << slow;
    }
  }
}

TEST(ForPhotographs, WhatComesBeforeAFailureIsWorkedOn) {
  std::size_t counted = 0;
  const auto work = [](std::size_t i) {
    if (i == 40 || i >= 150) throw std::runtime_error(std::to_string(i));
  };
  EXPECT_THROW(for_photographs(200, 1e5, work, [&](std::size_t) { ++counted; }),
               std::runtime_error);
  EXPECT_GE(counted, 40u);
}

}  // namespace
}  // namespace photohull
