// How much a test that samples does: little in everyday runs, more where somebody waits for it.
#pragma once

#include <algorithm>
#include <cstdlib>

namespace photohull::test {

/// The number in the environment variable PHOTOHULL_EFFORT, by which the samples of a test are to
/// be multiplied; 1 without it.
inline int effort() {
  const char* text = std::getenv("PHOTOHULL_EFFORT");
  return text ? std::max(1, std::atoi(text)) : 1;
}

}  // namespace photohull::test
