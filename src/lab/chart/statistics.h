// Means, fronts, fits and medians.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace photohull::chart {

/// Running mean of values that may be absent.
class Mean {
 public:
  void add(const std::optional<double>& value) {
    if (!value) return;
    sum_ += *value;
    ++count_;
  }
  std::optional<double> value() const {
    return count_ ? std::optional(sum_ / count_) : std::nullopt;
  }

 private:
  double sum_ = 0;
  int count_ = 0;
};

/// A run as seen by who chooses: low cost and high quality are good.
struct Choice {
  double cost = 0;
  double quality = 0;
};

/// Indices of the choices that none of the others beats, by rising cost: no other one costs no
/// more and is at least as good, and better in one of both. Of equal choices all are kept.
std::vector<std::size_t> pareto_front(std::span<const Choice> choices);

struct Sample {
  double x = 0, y = 0;
};

/// y = factor * x^exponent.
struct PowerLaw {
  double factor = 0, exponent = 0;
  int samples = 0;
  double at(double x) const;
};

/// Least squares in logarithms. Samples that are not positive are left out; nothing when fewer
/// than two different x remain.
std::optional<PowerLaw> fit_power_law(std::span<const Sample> samples);

/// Index of the middle value; of an even number the lower middle. Not empty.
std::size_t median_index(std::span<const double> values);

}  // namespace photohull::chart
