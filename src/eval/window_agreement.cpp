#include "eval/window_agreement.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace photohull::eval {
namespace {

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

/// Sums over some pixels, relative to a pixel of the window so that nothing cancels.
struct Sums {
  int pixels = 0;
  glm::dvec3 a{0}, b{0};
  double aa = 0, bb = 0, ab = 0;

  void add(const glm::dvec3& x, const glm::dvec3& y) {
    ++pixels;
    a += x, b += y;
    aa += glm::dot(x, x), bb += glm::dot(y, y), ab += glm::dot(x, y);
  }
  double variance_a() const { return (aa - glm::dot(a, a) / pixels) / (3.0 * pixels); }
  double variance_b() const { return (bb - glm::dot(b, b) / pixels) / (3.0 * pixels); }
  double covariance() const { return (ab - glm::dot(a, b) / pixels) / (3.0 * pixels); }
};

float at_pixel(const PicturePair& pair, int x, int y, int radius, double floor) {
  const std::size_t centre = std::size_t(y) * std::size_t(pair.width) + std::size_t(x);
  if (!pair.counts[centre]) return kNothing;
  const glm::dvec3 a0(pair.photo[centre]), b0(pair.prediction[centre]);
  Sums all, both;
  for (int v = std::max(y - radius, 0); v <= std::min(y + radius, pair.height - 1); ++v)
    for (int u = std::max(x - radius, 0); u <= std::min(x + radius, pair.width - 1); ++u) {
      const std::size_t i = std::size_t(v) * std::size_t(pair.width) + std::size_t(u);
      if (!pair.counts[i]) continue;
      const glm::dvec3 a = glm::dvec3(pair.photo[i]) - a0;
      all.add(a, glm::dvec3(0));
      if (pair.predicted[i]) both.add(a, glm::dvec3(pair.prediction[i]) - b0);
    }
  const int window = 2 * radius + 1;
  if (4 * all.pixels < window * window || all.variance_a() < floor) return kNothing;
  if (!pair.predicted[centre] || 2 * both.pixels < all.pixels) return 0;
  const double score = both.covariance() / std::sqrt(std::max(both.variance_a(), floor) *
                                                     std::max(both.variance_b(), floor));
  return float(std::clamp(score, -1.0, 1.0));
}

}  // namespace

std::vector<float> window_agreement(const PicturePair& pair, int window, double floor,
                                    const std::function<void()>& row_done) {
  const std::size_t size = std::size_t(pair.width) * std::size_t(pair.height);
  PHOTOHULL_CHECK(window % 2 == 1 && floor > 0);
  PHOTOHULL_CHECK(pair.photo.size() == size && pair.prediction.size() == size &&
                  pair.counts.size() == size && pair.predicted.size() == size);
  std::vector<float> scores(size);
  tbb::parallel_for(0, pair.height, [&](int y) {
    for (int x = 0; x < pair.width; ++x)
      scores[std::size_t(y) * std::size_t(pair.width) + std::size_t(x)] =
          at_pixel(pair, x, y, window / 2, floor);
    row_done();
  });
  return scores;
}

}  // namespace photohull::eval
