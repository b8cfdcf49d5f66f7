#include "views/photometric_check.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/median.h"

namespace photohull {
namespace {

constexpr int kGroups = 4;  // of each half, whose spread is the noise of vignetting
constexpr double kMostVignetting = 0.9;
constexpr double kClip = 3;  // median sizes of what is left
constexpr int kRounds = 15;  // of medians in turn: gains pass from view to view by shared points

/// What one half of the points says.
struct Half {
  std::vector<const PhotometricPoint*> points;
  std::vector<int> samples;       ///< of each view
  std::vector<glm::dvec3> gains;  ///< logarithms
  double vignetting = 0;
};

/// Logarithms of a point's colours in a channel, less what a half has found.
std::vector<double> corrected(const PhotometricPoint& point, int channel, const Half& found) {
  std::vector<double> out;
  for (const PhotometricSample& s : point.samples)
    out.push_back(std::log(s.colour[channel]) - found.gains[std::size_t(s.view)][channel] -
                  std::log(1 - found.vignetting * s.radius2));
  return out;
}

void centre(std::vector<glm::dvec3>& gains, const std::vector<bool>& used) {
  glm::dvec3 sum(0);
  for (std::size_t v = 0; v < gains.size(); ++v)
    if (used[v]) sum += gains[v];
  const double count = double(std::max<long>(1, std::count(used.begin(), used.end(), true)));
  for (std::size_t v = 0; v < gains.size(); ++v)
    gains[v] = used[v] ? gains[v] - sum / count : glm::dvec3(0);
}

void estimate(Half& half, const std::vector<bool>& used) {
  half.gains.assign(used.size(), glm::dvec3(0));
  for (int round = 0; round < kRounds; ++round) {
    std::vector<glm::dvec3> next(used.size(), glm::dvec3(0));
    for (int c = 0; c < 3; ++c) {
      std::vector<std::vector<double>> left(used.size());
      for (const PhotometricPoint* point : half.points) {
        const double albedo = median(corrected(*point, c, half));
        for (const PhotometricSample& s : point->samples)
          left[std::size_t(s.view)].push_back(std::log(s.colour[c]) - albedo);
      }
      for (std::size_t v = 0; v < used.size(); ++v)
        if (used[v]) next[v][c] = median(left[v]);
    }
    half.gains = std::move(next);
    centre(half.gains, used);
  }
}

/// Share of the light that the points say is lost in the corners, after the half's gains: by least
/// squares, outliers clipped; nothing where all are as far from the middle.
std::optional<double> vignetting_of(const std::vector<const PhotometricPoint*>& points,
                                    const Half& half) {
  std::vector<std::pair<double, double>> places;  // relative radius squared, what is left
  std::vector<double> sizes;
  for (const PhotometricPoint* point : points)
    for (int c = 0; c < 3; ++c) {
      const std::vector<double> values = corrected(*point, c, half);
      double radius = 0;
      for (const PhotometricSample& s : point->samples)
        radius += s.radius2 / double(point->samples.size());
      const double middle = median(values);
      for (std::size_t i = 0; i < values.size(); ++i) {
        places.emplace_back(point->samples[i].radius2 - radius, values[i] - middle);
        sizes.push_back(std::abs(values[i] - middle));
      }
    }
  const double clip = kClip * median(sizes);
  double xx = 0, xy = 0;
  for (const auto& [x, y] : places) xx += x * x, xy += x * std::clamp(y, -clip, clip);
  if (!(xx > 0)) return {};
  return -xy / xx;
}

/// From groups of the half's clusters: the mean goes to the half, the single ones to `all`.
void estimate_vignetting(Half& half, std::vector<double>& all) {
  double sum = 0;
  int count = 0;
  for (int group = 0; group < kGroups; ++group) {
    std::vector<const PhotometricPoint*> points;
    for (const PhotometricPoint* point : half.points)
      if (point->cluster / 2 % kGroups == group) points.push_back(point);
    if (const auto found = vignetting_of(points, half)) {
      all.push_back(*found);
      sum += *found;
      ++count;
    }
  }
  half.vignetting = count > 0 ? std::clamp(sum / count, 0.0, kMostVignetting) : 0;
}

/// Median deviation of the half's colours from each point's usual one.
double disagreement(const Half& half, const Half& found) {
  std::vector<double> all;
  for (const PhotometricPoint* point : half.points)
    for (int c = 0; c < 3; ++c) {
      const std::vector<double> values = corrected(*point, c, found);
      const double middle = median(values);
      for (const double v : values) all.push_back(std::abs(v - middle));
    }
  return all.empty() ? 0 : median(all);
}

}  // namespace

void PhotometricCheckOptions::validate() const {
  if (least_samples < 3)
    throw UsageError(concat("least_samples must be 3 or more, not ", least_samples));
  if (!(least_sigmas >= 0))
    throw UsageError(concat("least_sigmas must be >= 0, not ", least_sigmas));
  if (!(least_vignetting >= 0))
    throw UsageError(concat("least_vignetting must be >= 0, not ", least_vignetting));
  if (!(least_profit >= 0 && least_profit < 1))
    throw UsageError(concat("least_profit must lie in [0, 1), not ", least_profit));
}

PhotometricCheck check_photometric(const std::vector<PhotometricPoint>& points, int view_count,
                                   const PhotometricCheckOptions& options) {
  options.validate();
  PHOTOHULL_CHECK_OP(view_count, >, 0);
  PhotometricCheck out;
  Half halves[2];
  for (Half& half : halves) half.samples.assign(std::size_t(view_count), 0);
  for (const PhotometricPoint& point : points) {
    Half& half = halves[point.cluster % 2];
    half.points.push_back(&point);
    for (const PhotometricSample& s : point.samples) {
      PHOTOHULL_CHECK(s.view >= 0 && s.view < view_count);
      ++half.samples[std::size_t(s.view)];
      ++out.samples;
    }
  }
  out.points = int(points.size());
  std::vector<bool> used;
  for (std::size_t v = 0; v < std::size_t(view_count); ++v)
    used.push_back(std::min(halves[0].samples[v], halves[1].samples[v]) >= options.least_samples);
  out.views = int(std::count(used.begin(), used.end(), true));
  if (out.views < 2) return out;
  for (Half& half : halves) estimate(half, used);

  double alike = 0, apart = 0;
  for (std::size_t v = 0; v < used.size(); ++v) {
    const glm::dvec3 &a = halves[0].gains[v], &b = halves[1].gains[v];
    alike += glm::dot(a, b);
    apart += glm::dot(a - b, a - b) / 4;  // the variance of their mean
  }
  const double count = 3.0 * out.views;
  out.rms_gain = std::sqrt(std::max(0.0, alike / count));
  out.noise = std::sqrt(apart / count);
  Half none;
  none.gains.assign(used.size(), glm::dvec3(0));
  std::vector<double> lost;  // in the corners, as each group has it
  for (Half& half : halves) estimate_vignetting(half, lost);
  double mean = 0, squares = 0;
  for (const double v : lost) mean += v / double(lost.size());
  for (const double v : lost) squares += (v - mean) * (v - mean);
  out.vignetting = mean;
  if (lost.size() > 1)
    out.vignetting_noise = std::sqrt(squares / double(lost.size() * (lost.size() - 1)));
  const bool vignetted =
      lost.size() > 1 &&
      mean > std::max(options.least_vignetting, options.least_sigmas * out.vignetting_noise);
  if (!vignetted)
    for (Half& half : halves) half.vignetting = 0;
  double before = 0, after = 0;
  for (int i = 0; i < 2; ++i) {
    before += disagreement(halves[i], none);
    after += disagreement(halves[i], halves[1 - i]);
  }
  out.profit = before > 0 ? 1 - after / before : 0;
  const bool gains = out.rms_gain > options.least_sigmas * out.noise;
  out.differ = (gains || vignetted) && out.profit > options.least_profit;
  return out;
}

}  // namespace photohull
