// After: S. Seitz, C. Dyer 1997; K. Kutulakos, S. Seitz 2000 (variance); M. Stevens et al. 2002
// (histograms); R. Zabih, J. Woodfill 1994 (census).
#include "carving/statistic_reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/error.h"

namespace photohull::carving::reference {
namespace {

using glm::dvec3;
using Patches = std::vector<std::vector<dvec3>>;

constexpr std::size_t kLeastTaps = 13;

bool enough(const CommonPatches& p) {
  return p.views.size() >= 2 && p.views[0].size() >= kLeastTaps;
}

Evidence nothing(const CommonPatches& p) { return {-1, 0, int(p.views.size()), 1}; }

double score_of(double variance, double noise_variance, double texture) {
  const double allowed = 4 * noise_variance + 0.25 * texture;
  return std::max(1 - 0.3 * variance / allowed, -1.0);
}

/// Variance of numbers about their mean.
double variance_of(const std::vector<double>& values) {
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
  double sum = 0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return sum / double(values.size());
}

/// Mean over the channels of the variance over the taps.
double texture_of(const std::vector<dvec3>& patch) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (const dvec3& x : patch) values.push_back(x[c]);
    sum += variance_of(values) / 3;
  }
  return sum;
}

double mean_texture(const Patches& views) {
  double sum = 0;
  for (const auto& patch : views) sum += texture_of(patch);
  return sum / double(views.size());
}

double share_of_views(std::size_t n) { return 1 - 1 / double(n); }

double confidence_of(double contrast, std::size_t views, const ImageNoise& noise) {
  if (contrast < noise.least_texture) return 0;
  return share_of_views(views) * contrast / (contrast + noise.variance);
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

}  // namespace

Evidence gain_variance(const CommonPatches& patches, const ImageNoise& noise) {
  if (!enough(patches)) return nothing(patches);
  const std::size_t n = patches.views.size(), taps = patches.views[0].size();
  // Pattern and gains by turns, each the least-squares answer to the other.
  std::vector<dvec3> pattern(taps, dvec3(0));
  for (const auto& view : patches.views)
    for (std::size_t t = 0; t < taps; ++t) pattern[t] += view[t];
  std::vector<double> gains(n, 0);
  for (int round = 0; round < 500; ++round) {
    double norm = 0;
    for (const dvec3& p : pattern) norm += glm::dot(p, p);
    for (std::size_t v = 0; v < n; ++v) {
      gains[v] = 0;
      for (std::size_t t = 0; t < taps && norm > 0; ++t)
        gains[v] += glm::dot(pattern[t], patches.views[v][t]) / norm;
    }
    double gain_norm = 0;
    for (const double g : gains) gain_norm += g * g;
    if (!(gain_norm > 0)) break;
    for (std::size_t t = 0; t < taps; ++t) {
      pattern[t] = dvec3(0);
      for (std::size_t v = 0; v < n; ++v) pattern[t] += gains[v] / gain_norm * patches.views[v][t];
    }
  }
  double residual = 0, contrast = 0;
  for (std::size_t v = 0; v < n; ++v) {
    std::vector<double> values;
    for (std::size_t t = 0; t < taps; ++t) {
      const dvec3 d = patches.views[v][t] - gains[v] * pattern[t];
      residual += glm::dot(d, d);
      for (int c = 0; c < 3; ++c) values.push_back(patches.views[v][t][c]);
    }
    contrast += variance_of(values) / double(n);
  }
  residual /= double(n - 1) * double(3 * taps - 1);
  return {score_of(residual, noise.variance, contrast), confidence_of(contrast, n, noise), int(n),
          std::abs(contrast - noise.least_texture)};
}

Evidence adaptive_variance(const CommonPatches& patches, const ImageNoise& noise) {
  if (!enough(patches)) return nothing(patches);
  const std::size_t n = patches.views.size();
  double variance = 0;
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (const auto& view : patches.views) values.push_back(view[patches.middle][c]);
    variance += variance_of(values) * double(n) / double(n - 1) / 3;
  }
  return {score_of(variance, noise.variance, mean_texture(patches.views)), share_of_views(n),
          int(n), 1};
}

Evidence robust_variance(const CommonPatches& patches, const ImageNoise& noise) {
  if (!enough(patches)) return nothing(patches);
  const std::size_t n = patches.views.size(), taps = patches.views[0].size();
  std::vector<std::pair<double, std::size_t>> ranked;
  for (std::size_t v = 0; v < n; ++v) ranked.emplace_back(0.0, v);
  for (std::size_t t = 0; t < taps; ++t)
    for (int c = 0; c < 3; ++c) {
      std::vector<double> values;
      for (const auto& view : patches.views) values.push_back(view[t][c]);
      const double middle = median(values);
      for (std::size_t v = 0; v < n; ++v) ranked[v].first += std::pow(values[v] - middle, 2);
    }
  std::sort(ranked.begin(), ranked.end());
  const std::size_t used = std::max<std::size_t>(2, (2 * n + 2) / 3);
  Evidence out;
  out.used = int(used);
  // Equal ones go by their order, which rounding does not change.
  if (used < n && ranked[used].first > ranked[used - 1].first)
    out.margin = ranked[used].first - ranked[used - 1].first;
  Patches kept;
  for (std::size_t k = 0; k < used; ++k) kept.push_back(patches.views[ranked[k].second]);
  double variance = 0;
  for (std::size_t t = 0; t < taps; ++t)
    for (int c = 0; c < 3; ++c) {
      std::vector<double> values;
      for (const auto& view : kept) values.push_back(view[t][c]);
      variance += variance_of(values) * double(used) / double(used - 1) / double(3 * taps);
    }
  out.score = score_of(variance, noise.variance, mean_texture(kept));
  out.confidence = share_of_views(used);
  return out;
}

Evidence histogram_consistency(const CommonPatches& patches, const ImageNoise& noise) {
  if (!enough(patches)) return nothing(patches);
  constexpr int kBins = 8;
  const std::size_t n = patches.views.size(), taps = patches.views[0].size();
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    std::vector<std::array<double, kBins>> histograms(n, std::array<double, kBins>{});
    for (std::size_t v = 0; v < n; ++v)
      for (const dvec3& x : patches.views[v]) {
        const double place = std::clamp(x[c], 0.0, 1.0) * (kBins - 1);
        const int low = std::min(int(place), kBins - 2);
        histograms[v][low] += (low + 1 - place) / double(taps);
        histograms[v][low + 1] += (place - low) / double(taps);
      }
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j)
        for (int b = 0; b < kBins; ++b) sum += std::min(histograms[i][b], histograms[j][b]);
  }
  const double intersection = sum / (3 * 0.5 * double(n * (n - 1)));
  const double texture = mean_texture(patches.views);
  return {2 * intersection - 1, confidence_of(texture, n, noise), int(n),
          std::abs(texture - noise.least_texture)};
}

Evidence census(const CommonPatches& patches, const ImageNoise& noise) {
  if (!enough(patches)) return nothing(patches);
  const std::size_t n = patches.views.size(), taps = patches.views[0].size();
  // The difference of two sums of three channels has six times a channel's variance.
  const double tolerance = std::sqrt(6 * noise.variance);
  Evidence out;
  out.used = int(n);
  Patches signs(n);
  for (std::size_t v = 0; v < n; ++v) {
    const dvec3 m = patches.views[v][patches.middle];
    for (std::size_t t = 0; t < taps; ++t) {
      const dvec3 x = patches.views[v][t];
      const double d = x.r + x.g + x.b - m.r - m.g - m.b;
      if (t != patches.middle) out.margin = std::min(out.margin, std::abs(std::abs(d) - tolerance));
      signs[v].emplace_back(std::abs(d) > tolerance ? std::copysign(1.0, d) : 0.0);
    }
  }
  double informative = 0, differing = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j)
      for (std::size_t t = 0; t < taps; ++t) {
        if (t == patches.middle) continue;
        const double a = signs[i][t].x, b = signs[j][t].x;
        informative += a != 0 || b != 0;
        differing += std::abs(a - b);
      }
  const double share = informative / (0.5 * double(n * (n - 1)) * double(taps - 1));
  const double similarity = informative > 0 ? 1 - differing / informative : 1;
  out.score = similarity > 0 ? std::min(1.4 * similarity, 1.0) : similarity;
  out.confidence = share >= 0.25 ? share_of_views(n) * share : 0;
  return out;
}

}  // namespace photohull::carving::reference
