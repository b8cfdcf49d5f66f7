// Pixels, rounded for messages.
#pragma once

#include <cmath>

namespace photohull::pipeline {

inline double hundredths(double pixels) { return std::round(100 * pixels) / 100; }

}  // namespace photohull::pipeline
