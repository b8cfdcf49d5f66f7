// The median.
#pragma once

#include <algorithm>
#include <vector>

namespace photohull {

/// The median of the values: the greater of the two in the middle where there are two, and 0 where
/// there is no value.
inline double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + long(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace photohull
