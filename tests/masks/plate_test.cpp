// Masks from photographs of the background, GrabCut's contours, and how sure masks are.
#include <gtest/gtest.h>

#include <random>

#include "core/error.h"
#include "masks/mask_evidence.h"
#include "support/pictures.h"
#include "views/prepare_views.h"

namespace photohull {
namespace {

constexpr int kWidth = 240, kHeight = 180;

double disc(double x, double y) { return std::clamp(40.5 - std::hypot(x - 110, y - 90), 0.0, 1.0); }

/// A wall with stripes in every colour.
glm::vec3 wall(double x, double y) {
  return {float(0.35 + 0.2 * std::sin(0.12 * x)), float(0.35 + 0.2 * std::sin(0.1 * y + 1)),
          float(0.35 + 0.2 * std::cos(0.07 * (x + y)))};
}

glm::vec3 clay(double x, double y) {
  return {float(0.45 + 0.2 * std::sin(0.4 * x)), float(0.3 + 0.1 * std::cos(0.5 * y)), 0.12f};
}

ColourImage photograph(const Paint& paint, unsigned seed, float sigma = 0.008f) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, sigma);
  return paint_srgb(kWidth, kHeight, [&](double x, double y) {
    glm::vec3 root = glm::sqrt(paint(x, y));
    for (int c = 0; c < 3; ++c) root[c] = std::max(0.0f, root[c] + noise(random));
    return root * root;
  });
}

ColourImage scene(float exposure = 1, bool shadow = false) {
  return photograph(
      [=](double x, double y) {
        const bool dark = shadow && x > 140 && x < 200 && y > 70 && y < 120;
        return exposure *
               glm::mix((dark ? 0.55f : 1.0f) * wall(x, y), clay(x, y), float(disc(x, y)));
      },
      1);
}

struct Errors {
  int missing = 0, extra = 0;
};

/// Pixels of the disc (of 4800) that are not in the mask, and pixels `margin` off the disc that
/// are.
Errors errors(const Mask& mask, double margin = 4) {
  Errors e;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool in = mask.coverage[std::size_t(y) * kWidth + std::size_t(x)] >= 128;
      const double d = std::hypot(x - 110, y - 90) - 40;
      e.missing += d < -1 && !in;
      e.extra += d > margin && in;
    }
  return e;
}

double iou_of_disc(const Mask& mask) {
  double both = 0, either = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const bool in = mask.coverage[std::size_t(y) * kWidth + std::size_t(x)] >= 128;
      const bool truth = disc(x, y) >= 0.5;
      both += in && truth, either += in || truth;
    }
  return both / either;
}

TEST(Plate, FindsTheObjectBeforeAColourfulWall) {
  const ColourImage image = scene();
  const MaskEvidence evidence = compare_with_plate(image, photograph(wall, 2));
  const Mask mask = mask_from_evidence(evidence);
  const Errors e = errors(mask);
  EXPECT_LE(e.missing, 20);
  EXPECT_EQ(e.extra, 0);
  EXPECT_GT(iou_of_disc(mask), 0.97);
  EXPECT_GT(mask_confidence(evidence, mask, nullptr), MaskJudgement::kDoubtful);
}

TEST(Plate, ExposureMayDiffer) {
  const Errors e = errors(mask_from_evidence(compare_with_plate(scene(1.3f), photograph(wall, 2))));
  EXPECT_LE(e.missing, 20);
  EXPECT_EQ(e.extra, 0);
}

TEST(Plate, ShadowsAreNotTheObject) {
  const Mask mask = mask_from_evidence(compare_with_plate(scene(1, true), photograph(wall, 2)));
  const auto in = [&](int x, int y) {
    return mask.coverage[std::size_t(y) * kWidth + std::size_t(x)] >= 128;
  };
  int shadow = 0;
  for (int y = 75; y < 115; ++y)
    for (int x = 160; x < 195; ++x) shadow += in(x, y);
  EXPECT_LT(shadow, 40);  // of 1400
  EXPECT_TRUE(in(110, 90));
  EXPECT_LE(errors(mask).missing, 20);
}

TEST(Plate, NoiseSetsTheThreshold) {
  // A faint object that is lost in much noise, and clear in little.
  const auto faint = [](double x, double y) {
    return wall(x, y) + glm::vec3(float(0.12 * disc(x, y)));
  };
  const Mask clear = mask_from_evidence(
      compare_with_plate(photograph(faint, 1, 0.003f), photograph(wall, 2, 0.003f)));
  EXPECT_GT(iou_of_disc(clear), 0.9);
  const Mask noisy = mask_from_evidence(
      compare_with_plate(photograph(faint, 1, 0.05f), photograph(wall, 2, 0.05f)));
  EXPECT_LT(errors(noisy).extra, 200);
}

TEST(Plate, AnEmptySceneHasNoMask) {
  const MaskEvidence evidence = compare_with_plate(photograph(wall, 1), photograph(wall, 2));
  const Mask mask = mask_from_evidence(evidence);
  int inside = 0;
  for (const std::uint8_t c : mask.coverage) inside += c >= 128;
  EXPECT_LT(inside, 30);
}

TEST(Plate, SamplesOfOtherEncodingsCompare) {
  const ColourImage half = paint_half(kWidth, kHeight, [](double x, double y) {
    return glm::mix(wall(x, y), clay(x, y), float(disc(x, y)));
  });
  const Errors e = errors(mask_from_evidence(compare_with_plate(half, photograph(wall, 2))));
  EXPECT_LE(e.missing, 20);
  EXPECT_EQ(e.extra, 0);
}

TEST(Confidence, FallsWithTheContrastOfTheContour) {
  const auto confidence = [](float contrast) {
    const ColourImage image = photograph(
        [=](double x, double y) {
          const glm::vec3 w = wall(x, y);
          return glm::mix(w, glm::mix(w, clay(x, y), contrast), float(disc(x, y)));
        },
        1);
    const MaskEvidence evidence = compare_with_plate(image, photograph(wall, 2));
    return mask_confidence(evidence, mask_from_evidence(evidence), nullptr);
  };
  const double full = confidence(1), little = confidence(0.12f);
  EXPECT_GT(full, 0.85);
  EXPECT_LT(little, full - 0.2);
}

TEST(Confidence, FallsWhereAnotherMaskDisagrees) {
  const ColourImage image = scene();
  const MaskEvidence evidence = compare_with_plate(image, photograph(wall, 2));
  const Mask mask = mask_from_evidence(evidence);
  Mask half = mask;
  for (std::size_t i = 0; i < half.coverage.size(); ++i)
    if (i % kWidth < 110) half.coverage[i] = 0;
  EXPECT_LT(mask_confidence(evidence, mask, &half), 0.6 * mask_confidence(evidence, mask, &mask));
  const Mask none{kWidth, kHeight, std::vector<std::uint8_t>(mask.coverage.size(), 0)};
  EXPECT_EQ(mask_confidence(evidence, none, nullptr), 0);
}

TEST(CutBand, PutsAContourThatIsTooWideBack) {
  const ColourImage image = scene();
  const MaskEvidence evidence = compare_with_plate(image, photograph(wall, 2));
  Mask wide = mask_from_evidence(evidence);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      if (std::hypot(x - 110, y - 90) < 42)
        wide.coverage[std::size_t(y) * kWidth + std::size_t(x)] = 255;
  const Mask cut = cut_band(evidence, image, wide);
  EXPECT_GT(iou_of_disc(cut), iou_of_disc(wide) + 0.02);
  EXPECT_EQ(cut_band(evidence, image, wide).coverage, cut.coverage);  // the same every time
}

TEST(CutBand, GoesByColoursWhereTheEvidenceIsTheSameOnBothSides) {
  const ColourImage image = scene();
  MaskEvidence evidence{cv::Mat(kHeight, kWidth, CV_8U, cv::Scalar(0)), 50, 100, 0};
  Mask wide{kWidth, kHeight, std::vector<std::uint8_t>(std::size_t(kWidth) * kHeight, 0)};
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const double radius = std::hypot(x - 110, y - 90);
      evidence.distance.at<std::uint8_t>(y, x) = radius < 38 ? 100 : radius < 46 ? 90 : 0;
      if (radius < 43) wide.coverage[std::size_t(y) * kWidth + std::size_t(x)] = 255;
    }
  EXPECT_LT(iou_of_disc(wide), 0.91);
  EXPECT_GT(iou_of_disc(cut_band(evidence, image, wide)), 0.97);
}

/// Two upright bars, 2 pixels wide, in corners of a box so large that a sample of it misses both.
void expect_bars_to_stay(int apart) {
  constexpr int kSide = 600, kFirst = 60, kBar = 2, kLong = 30;
  const auto inside = [&](int x, int y) {
    const auto on_bar = [&](int from) {
      return x >= from && x < from + kBar && y >= from && y < from + kLong;
    };
    return on_bar(kFirst) || on_bar(kFirst + apart);
  };
  ColourImage image{kSide, kSide, ColourImage::Encoding::kSrgb8, false,
                    std::vector<std::uint8_t>(std::size_t(4) * kSide * kSide, 255)};
  Mask mask{kSide, kSide, std::vector<std::uint8_t>(std::size_t(kSide) * kSide, 0)};
  MaskEvidence evidence{cv::Mat(kSide, kSide, CV_8U, cv::Scalar(0)), 10, 30, 0};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const std::size_t i = std::size_t(y) * kSide + std::size_t(x);
      const auto grey = std::uint8_t((inside(x, y) ? 200 : 20) + (x * 7 + y * 3) % 5);
      for (const std::size_t c : {0, 1, 2}) image.bytes[4 * i + c] = grey;
      if (!inside(x, y)) continue;
      mask.coverage[i] = 255;
      evidence.distance.at<std::uint8_t>(y, x) = 200;
    }
  const Mask cut = cut_band(evidence, image, mask);
  for (std::size_t i = 0; i < cut.coverage.size(); ++i)
    ASSERT_EQ(cut.coverage[i] >= 128, mask.coverage[i] >= 128) << "pixel " << i;
}

TEST(CutBand, LearnsFromAllPixelsWhereTheObjectHasFew) {
  for (int apart = 424; apart < 434; ++apart) EXPECT_NO_THROW(expect_bars_to_stay(apart)) << apart;
}

}  // namespace
}  // namespace photohull
