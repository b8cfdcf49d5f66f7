// silhouette_distance against shapes whose distance is known.
#include "calib/silhouette.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace photohull {
namespace {

using Shape = std::function<double(double x, double y)>;  ///< signed distance, negative inside

/// Area coverage of each pixel, from 16 x 16 samples.
Mask rasterise(int width, int height, const Shape& shape) {
  constexpr int kSamples = 16;
  Mask mask{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      int inside = 0;
      if (const double d = shape(x, y); std::abs(d) > 1) {
        inside = d < 0 ? kSamples * kSamples : 0;
      } else {
        for (int i = 0; i < kSamples * kSamples; ++i)
          inside += shape(x - 0.5 + (i % kSamples + 0.5) / kSamples,
                          y - 0.5 + (i / kSamples + 0.5) / kSamples) < 0;
      }
      mask.coverage.push_back(std::uint8_t(std::lround(255.0 * inside / (kSamples * kSamples))));
    }
  return mask;
}

Mask hardened(Mask mask) {
  for (auto& c : mask.coverage) c = c >= 128 ? 255 : 0;
  return mask;
}

struct Disc {
  double x, y, radius;
};

Shape union_of(const std::vector<Disc>& discs) {
  return [discs](double x, double y) {
    double d = 1e9;
    for (const Disc& disc : discs)
      d = std::min(d, std::hypot(x - disc.x, y - disc.y) - disc.radius);
    return d;
  };
}

/// Points every 0.05 pixels on the boundary of a union of discs that lie on the image.
std::vector<glm::dvec2> boundary(const std::vector<Disc>& discs, int width, int height) {
  const Shape shape = union_of(discs);
  std::vector<glm::dvec2> points;
  for (const Disc& disc : discs) {
    const int n = int(disc.radius * 2 * M_PI / 0.05);
    for (int i = 0; i < n; ++i) {
      const double a = 2 * M_PI * i / n;
      const glm::dvec2 p(disc.x + disc.radius * std::cos(a), disc.y + disc.radius * std::sin(a));
      if (shape(p.x, p.y) > -1e-9 && p.x >= 0 && p.y >= 0 && p.x <= width - 1 && p.y <= height - 1)
        points.push_back(p);
    }
  }
  return points;
}

double brute_force(const std::vector<glm::dvec2>& points, int x, int y) {
  double best = 1e18;
  for (const glm::dvec2& p : points)
    best = std::min(best, (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y));
  return std::sqrt(best);
}

TEST(SilhouetteDistance, HalfPlaneAtAnyAngleAndOffset) {
  for (int i = 0; i < 40; ++i) {
    const double angle = 2 * M_PI * i / 40 + 0.01, offset = 0.137 * i;
    const Shape shape = [=](double x, double y) {
      return (x - 40) * std::cos(angle) + (y - 40) * std::sin(angle) - offset;
    };
    const SilhouetteDistance result = silhouette_distance(rasterise(81, 81, shape));
    for (int y = 10; y < 71; ++y)
      for (int x = 10; x < 71; ++x) {
        const double truth = shape(x, y);
        // The line ends at the frame: only pixels whose foot point is on the image compare.
        const double fx = x - truth * std::cos(angle), fy = y - truth * std::sin(angle);
        if (std::min({fx, fy, 80 - fx, 80 - fy}) < 2) continue;
        ASSERT_NEAR(result.pixels[std::size_t(y) * 81 + x], truth, 0.05)
            << x << "," << y << " angle " << angle;
      }
  }
}

TEST(SilhouetteDistance, AntiAliasedDisc) {
  for (double radius : {3.0, 7.3, 20.0, 33.7}) {
    const std::vector<Disc> discs{{50.3, 48.6, radius}};
    const Shape shape = union_of(discs);
    const SilhouetteDistance result = silhouette_distance(rasterise(101, 97, shape));
    for (int y = 0; y < 97; ++y)
      for (int x = 0; x < 101; ++x)
        ASSERT_NEAR(result.pixels[std::size_t(y) * 101 + x], shape(x, y),
                    0.1 + (std::abs(shape(x, y)) > 16 ? 0.3 * std::abs(shape(x, y)) : 0))
            << x << "," << y << " radius " << radius;
  }
}

TEST(SilhouetteDistance, MatchesBruteForceOnRandomBlobs) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  double worst_near = 0, worst_far = 0, worst_over = 0;
  for (int trial = 0; trial < 12; ++trial) {
    const int width = 90 + 7 * trial, height = 120 - 3 * trial;
    std::vector<Disc> discs;
    for (int i = 0; i < 8; ++i)
      discs.push_back({width * unit(random), height * unit(random), 3 + 12 * unit(random)});
    const auto points = boundary(discs, width, height);
    const Shape shape = union_of(discs);
    const SilhouetteDistance result = silhouette_distance(rasterise(width, height, shape));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const double truth = brute_force(points, x, y);
        const double found = result.pixels[std::size_t(y) * width + x];
        const double error = std::abs(found) - truth;
        if (truth > 0.05) EXPECT_EQ(found > 0, shape(x, y) > 0) << x << "," << y;
        if (truth < 4)
          worst_near = std::max(worst_near, std::abs(error));
        else
          worst_far = std::max(worst_far, std::abs(error) / truth);
        worst_over = std::max(worst_over, error);
      }
  }
  printf("%f %f %f\n", worst_near, worst_far, worst_over);
}

}  // namespace
}  // namespace photohull
