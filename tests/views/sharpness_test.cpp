#include "views/sharpness.h"

#include <gtest/gtest.h>

#include <random>

#include "support/ray_cast.h"

namespace photohull {
namespace {

const Box kBox{glm::dvec3(-1.1), glm::dvec3(1.1)};

/// Textured balls of radius 1 before grey, from cameras 15 degrees apart.
std::vector<PreparedView> photographs(double texture = 0.1, int count = 12) {
  std::vector<PreparedView> views;
  for (int i = 0; i < count; ++i) {
    const double a = 0.2618 * i;
    PreparedView view;
    view.camera = test::look_at({6 * std::cos(a), 6 * std::sin(a), 0}, {0, 0, 0}, 400, 160, 160);
    view.image = test::ray_cast(view.camera, [&](const glm::dvec3& eye, const glm::dvec3& ray) {
      const double b = glm::dot(eye, ray), c = glm::dot(eye, eye) - 1;
      if (b * b < c || texture == 0) return glm::dvec3(0.2);
      return test::noise_colour(eye + (-b - std::sqrt(b * b - c)) * ray, texture);
    });
    views.push_back(std::move(view));
  }
  return views;
}

/// The mean of `length` pixels to the right.
void move_while_exposed(ColourImage& image, int length) {
  const std::vector<std::uint8_t> sharp = image.bytes;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) {
        int sum = 0;
        for (int i = 0; i < length; ++i)
          sum += sharp[4 * (std::size_t(y) * image.width + std::min(x + i, image.width - 1)) + c];
        image.bytes[4 * (std::size_t(y) * image.width + x) + c] = std::uint8_t(sum / length);
      }
}

void add_noise(ColourImage& image, double deviation, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, deviation);
  for (std::size_t i = 0; i < image.bytes.size(); ++i)
    if (i % 4 != 3)
      image.bytes[i] =
          std::uint8_t(std::clamp(std::lround(image.bytes[i] + normal(random)), 0l, 255l));
}

TEST(Sharpness, ViewsOfTheSameAreAlike) {
  for (const double s : relative_sharpness(photographs(), kBox, 0)) EXPECT_NEAR(s, 1, 0.1);
}

TEST(Sharpness, TellsHowMuchAViewIsBlurred) {
  std::vector<PreparedView> views = photographs();
  move_while_exposed(views[3].image, 4);
  move_while_exposed(views[8].image, 12);
  const std::vector<double> s = relative_sharpness(views, kBox, 0);
  EXPECT_LT(s[3], 0.9);
  EXPECT_LT(s[8], 0.7);
  EXPECT_LT(s[8], s[3]);
  for (std::size_t i = 0; i < s.size(); ++i) {
    if (i != 3 && i != 8) {
      EXPECT_GT(s[i], 0.9) << i;
    }
  }
}

// Noise is fine detail too, and no sharpness.
TEST(Sharpness, NoiseDoesNotHideBlur) {
  std::vector<PreparedView> views = photographs();
  move_while_exposed(views[5].image, 12);
  for (std::size_t i = 0; i < views.size(); ++i) add_noise(views[i].image, 8, unsigned(i));
  // Noise of each channel by itself is less in brightness: sqrt(0.3^2 + 0.59^2 + 0.11^2).
  const double noise = 8 * 0.67 / 255;
  const double blurred = relative_sharpness(views, kBox, noise)[5];
  EXPECT_LT(blurred, 0.7);
  EXPECT_LT(blurred, 0.9 * relative_sharpness(views, kBox, 0)[5]);
}

TEST(Sharpness, ContrastIsNone) {
  std::vector<PreparedView> views = photographs();
  for (std::size_t i = 0; i < views[4].image.bytes.size(); ++i)
    if (i % 4 != 3) views[4].image.bytes[i] = std::uint8_t(views[4].image.bytes[i] / 2 + 30);
  EXPECT_NEAR(relative_sharpness(views, kBox, 0)[4], relative_sharpness(photographs(), kBox, 0)[4],
              0.05);
}

TEST(Sharpness, NothingToCompareWithIsSharp) {
  for (const double s : relative_sharpness(photographs(0), kBox, 0)) EXPECT_EQ(s, 1);
  for (const double s : relative_sharpness(photographs(0.1, 3), kBox, 0)) EXPECT_EQ(s, 1);
}

}  // namespace
}  // namespace photohull
