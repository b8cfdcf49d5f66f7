#include "lab/chart/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/error.h"

namespace photohull::chart {

std::vector<std::size_t> pareto_front(std::span<const Choice> choices) {
  std::vector<std::size_t> order(choices.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return choices[a].cost < choices[b].cost ||
           (choices[a].cost == choices[b].cost && choices[a].quality > choices[b].quality);
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order) {
    if (front.empty()) {
      front.push_back(i);
      continue;
    }
    const Choice& last = choices[front.back()];
    const bool equal = last.cost == choices[i].cost && last.quality == choices[i].quality;
    if (equal || choices[i].quality > last.quality) front.push_back(i);
  }
  return front;
}

double PowerLaw::at(double x) const { return factor * std::pow(x, exponent); }

std::optional<PowerLaw> fit_power_law(std::span<const Sample> samples) {
  double n = 0, sx = 0, sy = 0;
  const auto usable = [](const Sample& s) {
    return s.x > 0 && s.y > 0 && std::isfinite(s.x) && std::isfinite(s.y);
  };
  for (const Sample& s : samples) {
    if (!usable(s)) continue;
    n += 1;
    sx += std::log(s.x);
    sy += std::log(s.y);
  }
  if (n < 2) return std::nullopt;
  double sxx = 0, sxy = 0;
  for (const Sample& s : samples) {
    if (!usable(s)) continue;
    const double dx = std::log(s.x) - sx / n;
    sxx += dx * dx;
    sxy += dx * (std::log(s.y) - sy / n);
  }
  if (sxx < 1e-12) return std::nullopt;
  const double exponent = sxy / sxx;
  return PowerLaw{std::exp(sy / n - exponent * sx / n), exponent, int(n)};
}

std::size_t median_index(std::span<const double> values) {
  PHOTOHULL_CHECK(!values.empty());
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  return order[(order.size() - 1) / 2];
}

}  // namespace photohull::chart
