#include "eval/distance_stats.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace photohull::eval {
namespace {

std::size_t rank_of(double q, std::size_t count) {
  const double rank = std::ceil(q * double(count)) - 1;
  return rank > 0 ? std::min(std::size_t(rank), count - 1) : 0;
}

}  // namespace

double quantile(std::vector<double> values, double q) {
  PHOTOHULL_CHECK(!values.empty());
  const auto place = values.begin() + std::ptrdiff_t(rank_of(q, values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

DistanceStats distance_stats(const std::vector<double>& distances) {
  if (distances.empty()) return {};
  double sum = 0, squares = 0;
  for (const double d : distances) sum += d, squares += d * d;
  std::vector<double> sorted = distances;
  std::sort(sorted.begin(), sorted.end());
  const auto n = double(sorted.size());
  return {sum / n, sorted[rank_of(0.5, sorted.size())], std::sqrt(squares / n),
          sorted[rank_of(0.95, sorted.size())], sorted.back()};
}

double share_within(const std::vector<double>& values, double limit) {
  if (values.empty()) return 0;
  const auto within =
      std::count_if(values.begin(), values.end(), [limit](double v) { return v <= limit; });
  return double(within) / double(values.size());
}

}  // namespace photohull::eval
