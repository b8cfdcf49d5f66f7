// estimate_image_noise on pictures with known noise.
#include "photo/noise.h"

#include <gtest/gtest.h>

#include <random>

#include "support/pictures.h"

namespace photohull {
namespace {

/// Waves, edges and flat areas, as square roots of light in about [0.25, 0.8].
double texture(double x, double y) {
  if (x > 400) return 0.5 + 0.0003 * (x - 400) + 0.0002 * y;
  const double checks = (int(x / 24) + int(y / 24)) % 2 ? 0.1 : -0.1;
  return 0.5 + checks + 0.1 * std::sin(0.31 * x) * std::cos(0.23 * y);
}

/// The texture with Gaussian noise of `sigma` on the square root of a grey pixel's light.
Paint noisy(double sigma, std::mt19937& random) {
  return [=, &random](double x, double y) {
    std::normal_distribution<double> noise(0, sigma);
    const double root = texture(x, y) + (sigma > 0 ? noise(random) : 0);
    return glm::vec3(float(root * root));
  };
}

TEST(ImageNoise, FindsKnownSigmaOverTexture) {
  std::mt19937 random(5);
  for (const double sigma : {0.006, 0.015, 0.04, 0.08}) {
    EXPECT_NEAR(estimate_image_noise(paint_srgb(640, 480, noisy(sigma, random))) / sigma, 1, 0.3)
        << sigma;
    EXPECT_NEAR(estimate_image_noise(paint_half(640, 480, noisy(sigma, random))) / sigma, 1, 0.3)
        << sigma;
  }
}

TEST(ImageNoise, IsSmallWithoutNoise) {
  std::mt19937 random(5);
  EXPECT_LT(estimate_image_noise(paint_srgb(640, 480, noisy(0, random))), 0.003);
}

TEST(ImageNoise, IgnoresBlackAndClippedAreas) {
  // Noise in the middle only; the rest is black or white without any.
  std::mt19937 random(6);
  const Paint middle = noisy(0.03, random);
  const auto image = paint_srgb(640, 480, [&](double x, double y) {
    if (x < 420) return glm::vec3(0.0f);
    return x > 560 ? glm::vec3(1.0f) : middle(x, y);
  });
  EXPECT_NEAR(estimate_image_noise(image) / 0.03, 1, 0.3);
}

TEST(ImageNoise, IsZeroWhereNothingCanBeSaid) {
  const auto black = [](double, double) { return glm::vec3(0.0f); };
  EXPECT_EQ(estimate_image_noise(paint_srgb(64, 48, black)), 0);
  EXPECT_EQ(estimate_image_noise(paint_srgb(5, 3, black)), 0);
}

}  // namespace
}  // namespace photohull
