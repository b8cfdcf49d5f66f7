// Masks from the background model on painted scenes and on a real photograph set.
#include "masks/background.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "io/image_file.h"
#include "support/pictures.h"
#include "support/places.h"

namespace photohull {
namespace {

constexpr int kWidth = 320, kHeight = 240;

/// Coverage of the disc that every painted scene shows.
double disc(double x, double y) {
  return std::clamp(60.5 - std::hypot(x - 150, y - 120), 0.0, 1.0);
}

/// Four views of `paint` with Gaussian noise on its square root.
std::vector<ColourImage> photograph(const Paint& paint) {
  std::mt19937 random(9);
  std::normal_distribution<float> noise(0, 0.01f);
  std::vector<ColourImage> images;
  for (int i = 0; i < 4; ++i)
    images.push_back(paint_srgb(kWidth, kHeight, [&](double x, double y) {
      glm::vec3 root = glm::sqrt(paint(x, y));
      for (int c = 0; c < 3; ++c) root[c] = std::max(0.0f, root[c] + noise(random));
      return root * root;
    }));
  return images;
}

std::vector<const ColourImage*> pointers(const std::vector<ColourImage>& images) {
  std::vector<const ColourImage*> result;
  for (const ColourImage& image : images) result.push_back(&image);
  return result;
}

glm::vec3 mix(const glm::vec3& behind, const glm::vec3& front, double coverage) {
  return glm::mix(behind, front, float(coverage));
}

glm::vec3 clay(double x, double y) {
  return {float(0.4 + 0.2 * std::sin(0.2 * x)), float(0.3 + 0.1 * std::cos(0.3 * y)), 0.15f};
}

/// The mask is the disc: nothing of it is cut, and nothing 4 pixels off is kept.
void expect_disc(const Mask& mask, int most_missing = 0) {
  int missing = 0, extra = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool in = mask.coverage[std::size_t(y) * kWidth + std::size_t(x)] >= 128;
      const double d = std::hypot(x - 150, y - 120) - 60;
      missing += d < -1 && !in;
      extra += d > 4 && in;
    }
  EXPECT_LE(missing, most_missing);
  EXPECT_EQ(extra, 0);
}

void expect_disc_found(const Paint& paint, int most_missing = 0) {
  const auto images = photograph(paint);
  const BackgroundModel model = estimate_background(pointers(images));
  EXPECT_TRUE(model.usable()) << model.separation;
  for (const ColourImage& image : images)
    expect_disc(mask_from_background(model, image), most_missing);
}

TEST(Background, Black) {
  expect_disc_found(
      [](double x, double y) { return mix(glm::vec3(0.0f), clay(x, y), disc(x, y)); });
}

TEST(Background, GreyWallWithLightFalloff) {
  expect_disc_found([](double x, double y) {
    const glm::vec3 wall(float(0.35 + 0.0003 * x), float(0.36 + 0.0003 * x), 0.42f);
    return mix(wall, clay(x, y), disc(x, y));
  });
}

TEST(Background, DimClothOnBlack) {
  // A grey cloth with folds behind the left half, brighter than the object's shadows.
  expect_disc_found([](double x, double y) {
    const glm::vec3 cloth(float(0.022 + 0.012 * std::sin(0.1 * x + 0.05 * y)));
    return mix(x < 160 ? cloth : glm::vec3(0.0f), clay(x, y), disc(x, y));
  });
}

TEST(Background, HalfFloatImages) {
  const ColourImage image = paint_half(kWidth, kHeight, [](double x, double y) {
    return mix(glm::vec3(0.0f), 3.0f * clay(x, y), disc(x, y));  // brighter than 1
  });
  const BackgroundModel model = estimate_background({&image});
  EXPECT_TRUE(model.usable());
  expect_disc(mask_from_background(model, image));
}

TEST(Background, KeepsRealHolesAndThinBars) {
  // A frame of bars 4 pixels wide with openings of 40 pixels before black.
  const auto bars = [](double x, double y) {
    const bool in = x > 60 && x < 240 && y > 40 && y < 200;
    return in && (std::fmod(x - 60, 44) < 4 || std::fmod(y - 40, 52) < 4);
  };
  const auto images = photograph([&](double x, double y) {
    return bars(x, y) ? glm::vec3(0.5f, 0.4f, 0.3f) : glm::vec3(0.0f);
  });
  const BackgroundModel model = estimate_background(pointers(images));
  const Mask mask = mask_from_background(model, images[0]);
  int missing = 0, extra = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool in = mask.coverage[std::size_t(y) * kWidth + std::size_t(x)] >= 128;
      missing += bars(x, y) && !in;
      extra += in && !bars(x, y);
    }
  EXPECT_EQ(missing, 0);
  EXPECT_LT(extra, 1500);  // two pixels along the bars at most
}

TEST(Background, ClosesShadowsOfDoubtfulScenes) {
  // Dark cracks as black as the background, amid pixels of every shade.
  expect_disc_found(
      [](double x, double y) {
        const double crack = std::abs(std::fmod(x + 0.5 * y, 40) - 20) < 1.5 ? 0.0 : 1.0;
        const double shade = 0.02 + 0.98 * std::pow(0.5 + 0.5 * std::sin(0.15 * y), 2);
        return mix(glm::vec3(0.0f), float(crack * shade) * clay(x, y), disc(x, y));
      },
      60);  // of 11300; where a crack meets the contour
}

TEST(Background, GreyTellsHowSureAPixelIs) {
  // Cracks of background colour are closed.
  const auto crack = [](double x, double y) {
    return disc(x, y) > 0.9 && std::abs(std::fmod(x + 0.5 * y, 40) - 20) < 1.5;
  };
  const auto images = photograph([&](double x, double y) {
    const double shade = 0.02 + 0.98 * std::pow(0.5 + 0.5 * std::sin(0.15 * y), 2);
    return mix(glm::vec3(0.0f), float((crack(x, y) ? 0.0 : 1.0) * shade) * clay(x, y), disc(x, y));
  });
  const Mask mask = mask_from_background(estimate_background(pointers(images)), images[0]);
  double in_cracks = 0, cracks = 0, in_body = 0, body = 0;
  for (int y = 80; y < 160; ++y)
    for (int x = 110; x < 190; ++x) {
      const double c = mask.coverage[std::size_t(y) * kWidth + std::size_t(x)];
      ASSERT_GE(c, 128) << x << "," << y;
      (crack(x, y) ? in_cracks : in_body) += c, (crack(x, y) ? cracks : body) += 1;
    }
  ASSERT_GT(cracks, 100);
  EXPECT_LT(in_cracks / cracks, 190);
  EXPECT_GT(in_body / body, in_cracks / cracks + 30);
  // Far outside there is nothing.
  for (int y = 0; y < kHeight; ++y)
    for (int x = 260; x < kWidth; ++x)
      ASSERT_EQ(mask.coverage[std::size_t(y) * kWidth + std::size_t(x)], 0) << x << "," << y;
}

TEST(Background, ObjectCutByTheFrameStaysWhole) {
  // The bar runs out of the picture at the right in one view of four.
  auto images =
      photograph([](double x, double y) { return mix(glm::vec3(0.0f), clay(x, y), disc(x, y)); });
  images[0] = photograph([](double x, double y) {
    const double bar = x > 150 && std::abs(y - 120) < 20 ? 1.0 : disc(x, y);
    return mix(glm::vec3(0.0f), clay(x, y), bar);
  })[0];
  const BackgroundModel model = estimate_background(pointers(images));
  ASSERT_TRUE(model.usable());
  const Mask mask = mask_from_background(model, images[0]);
  for (int y = 104; y <= 136; ++y)
    for (int x = 150; x < kWidth; ++x)
      ASSERT_GE(mask.coverage[std::size_t(y) * kWidth + std::size_t(x)], 128) << x << "," << y;
}

TEST(Background, ContourIsSoftAndNearTheEdge) {
  const auto images =
      photograph([](double x, double y) { return mix(glm::vec3(0.0f), clay(x, y), disc(x, y)); });
  const Mask mask = mask_from_background(estimate_background(pointers(images)), images[0]);
  double area = 0;
  int soft = 0;
  for (const std::uint8_t c : mask.coverage) {
    area += c / 255.0;
    soft += c > 0 && c < 255;
  }
  const double radius = std::sqrt(area / M_PI);
  EXPECT_GT(radius, 59.9);
  EXPECT_LT(radius, 61.0);
  EXPECT_GT(soft, 150);
}

TEST(Background, HopelessScenesAreNotUsable) {
  const auto clutter = photograph([](double x, double y) {
    return glm::vec3(float(0.5 + 0.4 * std::sin(0.11 * x) * std::sin(0.07 * y)),
                     float(0.5 + 0.4 * std::sin(0.05 * x + 1) * std::cos(0.09 * y)),
                     float(0.5 + 0.4 * std::cos(0.08 * x + 0.1 * y)));
  });
  EXPECT_FALSE(estimate_background(pointers(clutter)).usable());
  const auto blank = photograph([](double, double) { return glm::vec3(0.3f); });
  EXPECT_FALSE(estimate_background(pointers(blank)).usable());
  const auto same = photograph(
      [](double x, double y) { return mix(glm::vec3(0.30f), glm::vec3(0.31f), disc(x, y)); });
  EXPECT_FALSE(estimate_background(pointers(same)).usable());
}

TEST(Background, TempleKeepsItsColumnsAndLosesTheCloth) {
  const std::filesystem::path folder = test::in_checkout("datasets/templeSparseRing");
  std::vector<ColourImage> images;
  for (const char* name : {"01", "04", "08", "12", "16"})
    images.push_back(io::read_image(folder / (std::string("templeSR00") + name + ".png")));
  const BackgroundModel model = estimate_background(pointers(images));
  ASSERT_TRUE(model.usable()) << model.separation;
  EXPECT_GT(model.separation, 0.7);
  for (const ColourImage& image : images) {
    const Mask mask = mask_from_background(model, image);
    const auto in = [&](int x, int y) {
      return mask.coverage[std::size_t(y) * image.width + std::size_t(x)] >= 128;
    };
    // Nothing but the temple is that bright; single pixels may mix temple and background.
    const auto bright = [&](int x, int y) {
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          if (image.bytes[(std::size_t(y + dy) * image.width + std::size_t(x + dx)) * 4] < 100)
            return false;
      return true;
    };
    int cut = 0, cloth = 0;
    for (int y = 1; y + 1 < image.height; ++y)
      for (int x = 1; x + 1 < image.width; ++x) {
        cut += bright(x, y) && !in(x, y);
        const bool at_frame = std::min({x, y, image.width - 1 - x, image.height - 1 - y}) < 20;
        cloth += at_frame && in(x, y);
      }
    EXPECT_LE(cut, 3);
    EXPECT_EQ(cloth, 0);
  }
}

}  // namespace
}  // namespace photohull
