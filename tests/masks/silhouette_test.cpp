// silhouette_distance against shapes whose distance is known.
#include "masks/silhouette.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

namespace photohull {
namespace {

using Shape = std::function<double(double x, double y)>;  ///< signed distance, negative inside

/// Area coverage of each pixel, from 16 x 16 samples that are themselves anti-aliased.
Mask rasterise(int width, int height, const Shape& shape) {
  constexpr int kSamples = 16;
  Mask mask{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      double inside = 0;
      if (const double d = shape(x, y); std::abs(d) > 1) {
        inside = d < 0 ? kSamples * kSamples : 0;
      } else {
        for (int i = 0; i < kSamples * kSamples; ++i)
          inside += std::clamp(0.5 - kSamples * shape(x - 0.5 + (i % kSamples + 0.5) / kSamples,
                                                      y - 0.5 + (i / kSamples + 0.5) / kSamples),
                               0.0, 1.0);
      }
      mask.coverage.push_back(std::uint8_t(std::lround(255.0 * inside / (kSamples * kSamples))));
    }
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

struct BoundaryPoint {
  double x, y;
  bool smooth;  ///< no other disc's edge is near: the 50 % contour follows the shape
};

/// Points every 0.05 pixels on the boundary of a union of discs that lie on the image.
std::vector<BoundaryPoint> boundary(const std::vector<Disc>& discs, int width, int height) {
  std::vector<BoundaryPoint> points;
  for (const Disc& disc : discs) {
    const int n = int(disc.radius * 2 * M_PI / 0.05);
    for (int i = 0; i < n; ++i) {
      const double a = 2 * M_PI * i / n;
      const double x = disc.x + disc.radius * std::cos(a), y = disc.y + disc.radius * std::sin(a);
      double others = 1e9;
      for (const Disc& other : discs)
        if (&other != &disc)
          others = std::min(others, std::hypot(x - other.x, y - other.y) - other.radius);
      if (others > 0 && x >= 0 && y >= 0 && x <= width - 1 && y <= height - 1)
        points.push_back({x, y, others > 2.5});
    }
  }
  return points;
}

const BoundaryPoint& nearest_of(const std::vector<BoundaryPoint>& points, int x, int y) {
  const auto squared = [&](const BoundaryPoint& p) {
    return (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y);
  };
  std::size_t best = 0;
  double least = 1e18;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const double d = squared(points[i]); d < least) {
      least = d;
      best = i;
    }
  return points[best];
}

/// Distance to the polygon that joins the middles between unlike neighbours of a hard mask.
double distance_to_hard_contour(const Mask& mask, int px, int py) {
  double best = 1e9;
  const auto at = [&](int x, int y) { return mask.coverage[std::size_t(y) * mask.width + x] > 0; };
  for (int y = 0; y + 1 < mask.height; ++y)
    for (int x = 0; x + 1 < mask.width; ++x) {
      std::vector<glm::dvec2> middles;
      if (at(x, y) != at(x + 1, y)) middles.emplace_back(x + 0.5, y);
      if (at(x + 1, y) != at(x + 1, y + 1)) middles.emplace_back(x + 1, y + 0.5);
      if (at(x, y + 1) != at(x + 1, y + 1)) middles.emplace_back(x + 0.5, y + 1);
      if (at(x, y) != at(x, y + 1)) middles.emplace_back(x, y + 0.5);
      // Top, right, bottom, left. Foreground corners that touch diagonally stay apart.
      if (middles.size() == 4 && at(x, y)) std::swap(middles[1], middles[3]);
      for (std::size_t i = 0; i + 1 < middles.size(); i += 2) {
        const glm::dvec2 d = middles[i + 1] - middles[i], p = glm::dvec2(px, py) - middles[i];
        const double s = std::clamp(glm::dot(p, d) / glm::dot(d, d), 0.0, 1.0);
        best = std::min(best, glm::length(p - s * d));
      }
    }
  return best;
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
        ASSERT_NEAR(result.pixels[std::size_t(y) * 81 + x], truth, std::abs(truth) < 2 ? 0.03 : 0.1)
            << x << "," << y << " angle " << angle;
      }
  }
}

TEST(SilhouetteDistance, AntiAliasedDisc) {
  for (double radius : {5.0, 7.3, 20.0, 33.7}) {
    const std::vector<Disc> discs{{50.3, 48.6, radius}};
    const Shape shape = union_of(discs);
    const SilhouetteDistance result = silhouette_distance(rasterise(101, 97, shape));
    for (int y = 0; y < 97; ++y)
      for (int x = 0; x < 101; ++x)
        ASSERT_NEAR(result.pixels[std::size_t(y) * 101 + x], shape(x, y), 0.1)
            << x << "," << y << " radius " << radius;
  }
}

TEST(SilhouetteDistance, MatchesBruteForceOnRandomBlobs) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0, 1);
  int compared = 0;
  for (int trial = 0; trial < 6; ++trial) {
    const int width = 90 + 7 * trial, height = 120 - 3 * trial;
    std::vector<Disc> discs;
    for (int i = 0; i < 8; ++i)
      discs.push_back({width * unit(random), height * unit(random), 3 + 12 * unit(random)});
    const auto points = boundary(discs, width, height);
    const Shape shape = union_of(discs);
    const SilhouetteDistance result = silhouette_distance(rasterise(width, height, shape));
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const BoundaryPoint& nearest = nearest_of(points, x, y);
        if (!nearest.smooth) continue;
        const double truth = std::copysign(std::hypot(nearest.x - x, nearest.y - y), shape(x, y));
        ASSERT_NEAR(result.pixels[std::size_t(y) * width + x], truth,
                    std::max(0.13, 0.02 * std::abs(truth)))
            << x << "," << y << " trial " << trial;
        ++compared;
      }
  }
  EXPECT_GT(compared, 40000);
}

TEST(SilhouetteDistance, MatchesBruteForceOnHardMasks) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 6; ++trial) {
    // Noise smoothed into blobs of all sizes, thin parts and specks included.
    const int width = 48, height = 40;
    std::vector<int> noise(std::size_t(width) * height);
    for (int& n : noise) n = int(random() % 100);
    Mask mask{width, height, std::vector<std::uint8_t>(noise.size(), 0)};
    const auto is_in = [&](int x, int y) {
      int sum = 0;
      for (int dy = -2; dy <= 2; ++dy)
        for (int dx = -2; dx <= 2; ++dx)
          sum += noise[std::size_t((y + dy + height) % height) * width + (x + dx + width) % width];
      return sum > 25 * (44 + 2 * trial);
    };
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        mask.coverage[std::size_t(y) * width + x] = is_in(x, y) ? 255 : 0;
    const SilhouetteDistance result = silhouette_distance(mask);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::size_t i = std::size_t(y) * width + x;
        ASSERT_EQ(result.pixels[i]<0, mask.coverage[i]> 0);
        ASSERT_NEAR(std::abs(result.pixels[i]), distance_to_hard_contour(mask, x, y), 0.1)
            << x << "," << y << " trial " << trial;
      }
  }
}

TEST(SilhouetteDistance, UniformMasksHaveNoContour) {
  const float none = SilhouetteDistance::kNoContour;
  Mask mask{13, 7, std::vector<std::uint8_t>(91, 0)};
  EXPECT_THAT(silhouette_distance(mask).pixels, testing::Each(none));
  mask.coverage.assign(91, 255);
  EXPECT_THAT(silhouette_distance(mask).pixels, testing::Each(-none));
  mask = {1, 1, {255}};
  EXPECT_THAT(silhouette_distance(mask).pixels, testing::ElementsAre(-none));
}

TEST(SilhouetteDistance, FrameIsNoContour) {
  // Foreground reaches three sides of the frame; only its left edge at x = 19.5 counts.
  Mask mask{60, 30, std::vector<std::uint8_t>(1800, 0)};
  for (int y = 0; y < 30; ++y)
    for (int x = 20; x < 60; ++x) mask.coverage[std::size_t(y) * 60 + x] = 255;
  const SilhouetteDistance result = silhouette_distance(mask);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 60; ++x)
      ASSERT_NEAR(result.pixels[std::size_t(y) * 60 + x], 19.5 - x, 1e-3) << x << "," << y;
}

TEST(SilhouetteDistance, KeepsSinglePixelParts) {
  Mask mask{9, 9, std::vector<std::uint8_t>(81, 0)};
  mask.coverage[4 * 9 + 4] = 255;
  const SilhouetteDistance result = silhouette_distance(mask);
  EXPECT_LT(result.pixels[4 * 9 + 4], -0.3f);
  EXPECT_NEAR(result.pixels[4 * 9 + 7], 2.5f, 1e-3);
}

TEST(WeighByCertainty, DistancesOutsideByHowSureTheMaskIs) {
  const Mask mask{4, 1, {0, 51, 127, 200}};
  SilhouetteDistance distance{4, 1, {8, 5, 2, -3}};
  weigh_by_certainty(mask, distance);
  EXPECT_FLOAT_EQ(distance.pixels[0], 8);
  EXPECT_NEAR(distance.pixels[1], 5 * 0.6, 1e-5);
  EXPECT_NEAR(distance.pixels[2], 0, 0.01);
  EXPECT_FLOAT_EQ(distance.pixels[3], -3);
}

}  // namespace
}  // namespace photohull
