#include "synth/degrade_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/image.h"

namespace photohull::synth {
namespace {

Picture flat(int width, int height, float light) {
  Picture p;
  p.width = width, p.height = height;
  p.colour.assign(std::size_t(width) * height, glm::vec3(light));
  return p;
}

struct Moments {
  double mean = 0, deviation = 0;
};

/// Of one channel, in linear light.
Moments moments(const std::vector<std::uint8_t>& rgb, int channel) {
  double sum = 0, squares = 0;
  for (std::size_t i = std::size_t(channel); i < rgb.size(); i += 3) {
    const double v = linear_from_srgb(rgb[i] / 255.0);
    sum += v, squares += v * v;
  }
  const double n = double(rgb.size() / 3);
  return {sum / n, std::sqrt(squares / n - sum * sum / (n * n))};
}

TEST(Noise, HasTheDeviationAskedFor) {
  DegradationSpec spec;
  spec.read_noise = 0.01, spec.photon_noise = 0.03;
  for (const float light : {0.2f, 0.6f}) {
    const auto rgb = expose(flat(200, 150, light), spec, 5, 0);
    const double expected = std::sqrt(0.01 * 0.01 + 0.03 * 0.03 * light);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(moments(rgb, c).deviation, expected, 0.03 * expected) << light;
      EXPECT_NEAR(moments(rgb, c).mean, light, 0.002);
    }
  }
  EXPECT_NE(expose(flat(20, 20, 0.5f), spec, 5, 0), expose(flat(20, 20, 0.5f), spec, 5, 1));
  EXPECT_NE(expose(flat(20, 20, 0.5f), spec, 5, 0), expose(flat(20, 20, 0.5f), spec, 6, 0));
  EXPECT_EQ(expose(flat(20, 20, 0.5f), spec, 5, 3), expose(flat(20, 20, 0.5f), spec, 5, 3));
}

TEST(Noise, OfTheCodesHasTheDeviationAskedForInCodes) {
  DegradationSpec spec;
  spec.code_noise = 6;
  for (const int code : {60, 190}) {
    const auto rgb = expose(flat(200, 150, float(linear_from_srgb(code / 255.0))), spec, 5, 0);
    double sum = 0, squares = 0;
    for (const std::uint8_t v : rgb) sum += v, squares += double(v) * v;
    const double n = double(rgb.size()), mean = sum / n;
    EXPECT_NEAR(mean, code, 0.1);
    EXPECT_NEAR(std::sqrt(squares / n - mean * mean), 6, 0.15) << code;
  }
}

TEST(Exposure, At16BitsHasThatManyLevels) {
  for (const double encoded : {0.0, 0.1, 0.70001, 1.0}) {
    const auto rgb = expose_16_bits(flat(1, 1, float(linear_from_srgb(encoded))), {}, 1, 0);
    ASSERT_EQ(rgb.size(), 3u);
    EXPECT_NEAR(rgb[1] / 65535.0, encoded, 1.0 / 65535);
  }
}

TEST(Exposure, WithoutDegradationTheCodesAreExact) {
  for (int code = 0; code < 256; ++code) {
    const auto rgb = expose(flat(1, 1, float(linear_from_srgb(code / 255.0))), {}, 1, 0);
    EXPECT_EQ(rgb, std::vector<std::uint8_t>(3, std::uint8_t(code)));
  }
}

TEST(Exposure, GainsSpreadAsAskedFor) {
  DegradationSpec spec;
  spec.exposure = 0.3, spec.white_balance = 0.1;
  double green = 0, red = 0;
  constexpr int kViews = 2000;
  for (int view = 0; view < kViews; ++view) {
    const auto rgb = expose(flat(1, 1, 0.2f), spec, 9, std::size_t(view));
    const double g = std::log2(linear_from_srgb(rgb[1] / 255.0) / 0.2);
    const double r = std::log2(linear_from_srgb(rgb[0] / 255.0) / 0.2) - g;
    green += g * g, red += r * r;
  }
  EXPECT_NEAR(std::sqrt(green / kViews), 0.3, 0.02);
  EXPECT_NEAR(std::sqrt(red / kViews), 0.1, 0.01);
}

TEST(Vignetting, TakesItsShareInTheCorners) {
  DegradationSpec spec;
  spec.vignetting = 0.4;
  const auto rgb = expose(flat(65, 49, 0.5f), spec, 1, 0);
  EXPECT_NEAR(linear_from_srgb(rgb[0] / 255.0), 0.3, 0.004);
  EXPECT_NEAR(linear_from_srgb(rgb[3 * (24 * 65 + 32)] / 255.0), 0.5, 0.004);
}

TEST(Blur, SpreadsAPointAsAGaussian) {
  std::vector<glm::vec3> image(41 * 41, glm::vec3(0));
  image[20 * 41 + 20] = glm::vec3(1);
  blur(image, 41, 41, 1.7);
  double sum = 0, variance = 0;
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 41; ++x) {
      sum += image[std::size_t(y) * 41 + x].g;
      variance += image[std::size_t(y) * 41 + x].g * (x - 20) * (x - 20);
    }
  EXPECT_NEAR(sum, 1, 1e-5);
  EXPECT_NEAR(std::sqrt(variance), 1.7, 0.01);
}

TEST(Jpeg, LosesMoreAtLowerQuality) {
  std::vector<std::uint8_t> rgb(64 * 48 * 3);
  for (std::size_t i = 0; i < rgb.size(); ++i)
    rgb[i] = std::uint8_t(128 + 60 * std::sin(0.01 * double(i % 997)) + double(i * 7919 % 31));
  const auto error = [&](int quality) {
    const auto coded = through_jpeg(rgb, 64, 48, quality);
    double sum = 0;
    for (std::size_t i = 0; i < rgb.size(); ++i)
      sum += (double(coded[i]) - rgb[i]) * (double(coded[i]) - rgb[i]);
    return std::sqrt(sum / double(rgb.size()));
  };
  EXPECT_GT(error(95), 0);
  EXPECT_LT(error(95), 20);
  EXPECT_GT(error(10), 1.2 * error(95));
  EXPECT_EQ(through_jpeg(rgb, 64, 48, 50), through_jpeg(rgb, 64, 48, 50));
}

TEST(MotionBlur, IsTheMeanAlongALine) {
  std::vector<glm::vec3> image(41 * 41, glm::vec3(0));
  image[20 * 41 + 20] = glm::vec3(1);
  motion_blur(image, 41, 41, 8, 0);  // to the right and left
  float sum = 0;
  for (int y = 0; y < 41; ++y)
    for (int x = 0; x < 41; ++x) {
      const float v = image[std::size_t(y) * 41 + x].r;
      sum += v;
      if (y != 20 || std::abs(x - 20) > 5) {
        EXPECT_EQ(v, 0) << x << " " << y;
      }
      if (y == 20 && std::abs(x - 20) < 4) {
        EXPECT_NEAR(v, 1.0f / 8.5f, 0.01f);
      }
    }
  EXPECT_NEAR(sum, 1, 1e-5);
}

TEST(MotionBlur, TakesItsShareOfTheViews) {
  DegradationSpec spec;
  int none = 0, quarter = 0;
  for (std::size_t view = 0; view < 40; ++view) none += is_motion_blurred(spec, view);
  spec.motion_blur = 5;
  for (std::size_t view = 0; view < 40; ++view) quarter += is_motion_blurred(spec, view);
  EXPECT_EQ(none, 0);
  EXPECT_EQ(quarter, 10);
}

}  // namespace
}  // namespace photohull::synth
