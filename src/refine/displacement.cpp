#include "refine/displacement.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace photohull::refine {
namespace {

/// Of the fairing in Jacobi's method, whose operator (the Laplacian's square) reaches up to 4.
constexpr double kDamping = 2;
constexpr double kDistinctBy = 0.1;  // lead over the second peak that gives full weight

template <typename F>
void for_vertices(std::size_t count, F&& f) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 2048), [&](const auto& range) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) f(i);
  });
}

}  // namespace

void aggregate(const VertexGraph& graph, int passes, Matches& matches) {
  const std::size_t k = std::size_t(matches.range.count);
  std::vector<float> next(matches.scores.size());
  for (int pass = 0; pass < passes; ++pass) {
    for_vertices(graph.vertices(), [&](std::size_t i) {
      float* out = next.data() + i * k;
      const auto own = matches.of(i);
      std::fill(out, out + k, 0.0f);
      int known = 0;
      for (const std::uint32_t j : graph.of(i)) {
        const auto other = matches.of(j);
        if (other[0] == kNoScore) continue;
        ++known;
        for (std::size_t o = 0; o < k; ++o) out[o] += other[o];
      }
      const bool self = own[0] != kNoScore;
      for (std::size_t o = 0; o < k; ++o) {
        if (!self && !known)
          out[o] = kNoScore;
        else if (!known)
          out[o] = own[o];
        else
          out[o] = self ? 0.5f * (own[o] + out[o] / float(known)) : out[o] / float(known);
      }
    });
    matches.scores.swap(next);
  }
}

std::vector<Peak> find_peaks(const Matches& matches, const PeakOptions& options) {
  const std::size_t k = std::size_t(matches.range.count);
  std::vector<Peak> peaks(k ? matches.scores.size() / k : 0);
  for_vertices(peaks.size(), [&](std::size_t i) {
    const auto s = matches.of(i);
    if (s[0] == kNoScore) return;
    std::size_t best = 0;
    for (std::size_t o = 1; o + 1 < k; ++o)
      if (s[o] >= s[o - 1] && s[o] > s[o + 1] && (best == 0 || s[o] > s[best])) best = o;
    // Noise leaves of a true match's correlation the share of the variance that is texture; where
    // it explains most of the variance, what correlates may be noise as well.
    const double texture = matches.texture[i];
    const double score = s[best] / std::max(texture, 1 - texture);
    if (best == 0 || score < options.least_score) return;
    float second = -1;
    for (std::size_t o = 0; o < k; ++o) {
      if (o + 1 >= best && o <= best + 1) continue;
      const bool peak = (o == 0 || s[o] >= s[o - 1]) && (o + 1 == k || s[o] >= s[o + 1]);
      if (peak) second = std::max(second, s[o]);
    }
    const double curvature = s[best - 1] - 2.0 * s[best] + s[best + 1];
    const double shift =
        curvature < 0 ? std::clamp(0.5 * (s[best - 1] - s[best + 1]) / curvature, -0.5, 0.5) : 0;
    const double sure = (score - options.least_score) / (options.full_score - options.least_score);
    const double lead = (s[best] - second) / kDistinctBy;
    const double sharp = -curvature / 0.05;
    peaks[i].offset = float(matches.range.at(double(best) + shift));
    peaks[i].score = s[best];
    peaks[i].weight = float(std::clamp(sure, 0.0, 1.0) * std::clamp(lead, 0.1, 1.0) *
                            std::clamp(sharp, 0.1, 1.0));
  });
  return peaks;
}

std::vector<float> regularize(const VertexGraph& graph, const std::vector<Peak>& peaks,
                              std::span<const glm::vec3> positions,
                              std::span<const glm::vec3> normals, std::span<const float> fair,
                              const RegularizeOptions& options) {
  const std::size_t n = peaks.size();
  std::vector<float> d(n, 0.0f), next(n), weight(n), height(n);
  for (int outer = 0; outer < options.reweightings; ++outer) {
    for_vertices(n, [&](std::size_t i) {
      const double off = outer == 0 ? 0 : (peaks[i].offset - d[i]) / options.robust;
      weight[i] = float(peaks[i].weight / ((1 + off * off) * (1 + off * off)));
    });
    for (int iteration = 0; iteration < options.iterations; ++iteration) {
      // How far the moved vertices' neighbours stand above them.
      for_vertices(n, [&](std::size_t i) {
        glm::vec3 middle(0);
        for (const std::uint32_t j : graph.of(i))
          middle += positions[j] + d[j] * normals[j] - positions[i];
        height[i] =
            glm::dot(middle, normals[i]) / float(std::max<std::size_t>(graph.of(i).size(), 1));
      });
      for_vertices(n, [&](std::size_t i) {
        const auto around = graph.of(i);
        double sum = 0, curved = 0;
        for (const std::uint32_t j : around) {
          sum += d[j];
          curved += height[j] - d[j];
        }
        const double count = double(std::max<std::size_t>(around.size(), 1));
        const double m = around.empty() ? 0 : options.membrane;
        const double f = around.empty() ? 0 : fair[i] * options.fairing;
        const double even = kDamping * d[i] + (height[i] - d[i]) - curved / count;
        next[i] = float((weight[i] * peaks[i].offset + m * sum / count + f * even) /
                        (weight[i] + m + kDamping * f + 1e-3));
      });
      d.swap(next);
    }
  }
  return d;
}

}  // namespace photohull::refine
